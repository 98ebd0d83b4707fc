"""The command line: one module per command; heavy libraries are loaded by the command that runs."""

from .group import main

__all__ = ["main"]
