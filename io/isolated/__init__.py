"""Native readers of untrusted files, run in a child process with limits of time and memory."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .answers import Answer, Refusal
    from .limits import Limits, choose_limits
    from .workers import run_isolated, stream_isolated
else:  # a type checker takes every name for one that such a __getattr__ has
    from ..._lazy import lazy_names

    # A program that may fork its readers asks for that at its start, without numpy.
    __getattr__, __dir__ = lazy_names(
        __name__,
        {
            ".answers": ("Answer", "Refusal"),
            ".limits": ("Limits", "choose_limits"),
            ".workers": ("run_isolated", "stream_isolated"),
        },
    )

__all__ = ["Answer", "Limits", "Refusal", "choose_limits", "run_isolated", "stream_isolated"]
