"""What the lines of a surface are: kind, source, priority and name of each."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int32Array
    from ...base.policies import LineKind
    from .breaklines import Lines


def label_line(lines: Lines | ConstraintTable, line: int) -> str:
    """Return what one of some lines is called in sentences, such as "breakline 2 'kerb'"."""
    kind = lines.kinds[line]
    noun = "breakline" if kind in ("hard", "soft") else kind
    name = f" '{lines.names[line]}'" if lines.names[line] else ""
    return f"{noun} {int(lines.sources[line])}{name}"


class ConstraintTable(NamedTuple):
    """A row for each line, in columns.

    A source is the caller's number within breaklines, boundary, holes or water; -1 for none.
    """

    kinds: tuple[LineKind, ...]
    sources: Int32Array
    priorities: Float64Array
    names: tuple[str, ...]

    @classmethod
    def of_kind(
        cls, kind: LineKind, sources: Int32Array, priorities: Float64Array
    ) -> ConstraintTable:
        """Return nameless lines that are all of one kind."""
        return cls((kind,) * len(sources), sources, priorities, ("",) * len(sources))

    @classmethod
    def join(cls, tables: Sequence[ConstraintTable]) -> ConstraintTable:
        """Return the rows of several tables as one."""
        return cls(
            tuple(kind for table in tables for kind in table.kinds),
            np.concatenate([table.sources for table in tables]),
            np.concatenate([table.priorities for table in tables]),
            tuple(name for table in tables for name in table.names),
        )

    def take(self, rows: AnyArray) -> ConstraintTable:
        """Return some rows, by their numbers."""
        numbers = rows.tolist()
        return ConstraintTable(
            tuple(self.kinds[i] for i in numbers),
            self.sources[rows],
            self.priorities[rows],
            tuple(self.names[i] for i in numbers),
        )

    def is_kind(self, *kinds: LineKind) -> BoolArray:
        """Tell which lines are of one of some kinds."""
        return np.array([kind in kinds for kind in self.kinds], np.bool_)

    def label(self, line: int) -> str:
        """Return what a line is called in sentences."""
        return label_line(self, line)
