# Public names, each with the module that has it: type checkers and `_lazy` read them here.
from .answers import Answer as Answer
from .answers import Refusal as Refusal
from .limits import Limits as Limits
from .limits import choose_limits as choose_limits
from .workers import run_isolated as run_isolated
from .workers import start_early as start_early
from .workers import stream_isolated as stream_isolated
