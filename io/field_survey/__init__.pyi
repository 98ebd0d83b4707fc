# Public names, each with the module that has it: type checkers and `_lazy` read them here.
from . import field_codes as field_codes
