"""Native readers of untrusted files, run in a child process with limits of time and memory."""

from .answers import Answer, Refusal
from .limits import Limits, limits_for
from .workers import run_isolated, stream_isolated

__all__ = ["Answer", "Limits", "Refusal", "limits_for", "run_isolated", "stream_isolated"]
