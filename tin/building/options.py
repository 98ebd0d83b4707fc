"""Options of a build: how rows are merged, lines are cut, and the surface is trimmed."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ...base.checks import as_flag, require_distance, require_positive
from ...base.errors import choice
from ...base.policies import CrossingPolicy, DuplicatePolicy, TrimPolicy
from ..validation import thread_count


@dataclass(frozen=True, kw_only=True)
class BuildOptions:
    """The options of :func:`tinsmith.triangulate` that are no data, checked.

    Raises
    ------
    OptionError
        If one is none of the allowed.
    """

    max_edge: float | None = None
    trim: TrimPolicy = "perimeter"
    crossing: CrossingPolicy = "split"
    conforming: bool = False
    duplicates: DuplicatePolicy = "mean"
    snap: float = 0.0
    threads: int | None = None

    def __post_init__(self) -> None:
        choice("duplicates", self.duplicates, DuplicatePolicy)
        choice("trim", self.trim, TrimPolicy)
        choice("crossing", self.crossing, CrossingPolicy)
        require_distance("snap", self.snap)
        require_positive("max_edge", self.max_edge)
        thread_count(self.threads, 0)
        set_plain = object.__setattr__  # no types of NumPy
        set_plain(self, "snap", float(self.snap))
        set_plain(self, "conforming", as_flag("conforming", self.conforming))
        if self.max_edge is not None:
            set_plain(self, "max_edge", float(self.max_edge))

    def scale(self, length: float) -> BuildOptions:
        """Return the same options where lengths in the plane are so many times as long."""
        max_edge = None if self.max_edge is None else self.max_edge * length
        return replace(self, max_edge=max_edge, snap=self.snap * length)
