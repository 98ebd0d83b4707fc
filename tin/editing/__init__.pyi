# Names that other packages use, each with the module that has it.
from .accounts import account_for_fewer_vertices as account_for_fewer_vertices
from .editable import Editable as Editable
from .history import apply_edits as apply_edits
from .session import Origin as Origin
