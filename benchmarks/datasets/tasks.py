"""Tasks of several arrays, as files between processes."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np

__all__ = ["read_task", "write_task"]

Task = TypeVar("Task", bound=NamedTuple)


def write_task(task: Any, path: Path) -> None:
    """Write a named tuple of arrays."""
    np.savez(path, **task._asdict())


def read_task(kind: type[Task], path: Path) -> Task:
    """Read what :func:`write_task` wrote."""
    with np.load(path) as arrays:
        return kind(**arrays)
