"""Native readers of untrusted files, run in a child process with limits of time and memory."""

from typing import TYPE_CHECKING

from ..._lazy import lazy_names

if TYPE_CHECKING:
    from .answers import Answer, Refusal
    from .limits import Limits, limits_for
    from .workers import run_isolated, stream_isolated

# A program that may fork its readers asks for that at its start, without numpy.
__getattr__, __dir__ = lazy_names(
    __name__,
    {
        ".answers": ("Answer", "Refusal"),
        ".limits": ("Limits", "limits_for"),
        ".workers": ("run_isolated", "stream_isolated"),
    },
)

__all__ = ["Answer", "Limits", "Refusal", "limits_for", "run_isolated", "stream_isolated"]
