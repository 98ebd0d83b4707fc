# Public names, each with the module that has it: type checkers and `_lazy` read them here.
from .answers import Answer as Answer
from .answers import Refusal as Refusal
from .limits import Limits as Limits
from .limits import choose_limits as choose_limits
from .spooling import describe_system_error as describe_system_error
from .spooling import is_pipe as is_pipe
from .spooling import open_ordinary_file as open_ordinary_file
from .spooling import require_local as require_local
from .spooling import require_readable as require_readable
from .spooling import spool as spool
from .spooling import translate_system_errors as translate_system_errors
from .workers import run_isolated as run_isolated
from .workers import start_early as start_early
from .workers import stream_isolated as stream_isolated
