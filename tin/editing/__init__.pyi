# Names that other packages use, each with the module that has it.
from .accounts import account_for_edits as account_for_edits
from .accounts import account_for_removed as account_for_removed
from .accounts import renumber_vertices as renumber_vertices
from .editable import Editable as Editable
from .history import apply_edits as apply_edits
from .session import Origin as Origin
