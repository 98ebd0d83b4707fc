# Names that other packages use, each with the module that has it.
from .findings import blunders as blunders
from .findings import drop_blunders as drop_blunders
from .findings import list_wrong_rows as list_wrong_rows
from .findings import screen as screen
