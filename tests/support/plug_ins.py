"""Distributions with entry points, as installed ones are found, without installing any."""

from __future__ import annotations

from types import SimpleNamespace

from tinsmith.base import plug_ins
from tinsmith.cli import plug_in_commands as commands
from tinsmith.io.registry import lookup


class Entry:
    """An entry point of a distribution; what it names is at hand, or an error to be raised."""

    def __init__(self, name, value, distribution="ground-plus", version="1.2"):
        self.name, self.value = name, value
        self.dist = distribution and SimpleNamespace(name=distribution, version=version)

    def load(self):
        if isinstance(self.value, BaseException):
            raise self.value
        return self.value


def install(monkeypatch, *entries, group):
    """Let these be all the entry points of a group."""
    monkeypatch.setattr(
        plug_ins, "entry_points", lambda **asked: entries if asked["group"] == group else ()
    )
    forget()


def forget():
    """Forget which plug-ins were found."""
    lookup.known_formats.cache_clear()
    commands.find_commands.cache_clear()
