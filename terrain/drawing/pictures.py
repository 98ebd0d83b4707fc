"""Pictures: files of figures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base.atomic import replacing

if TYPE_CHECKING:
    from pathlib import Path

PICTURE_SUFFIXES = (".png",)
"""File name endings of what :func:`save_figure` writes."""


def save_figure(figure: Any, path: Path, *, dpi: int) -> None:
    """Write a figure of matplotlib, whole or not at all, with no version in its bytes."""
    with replacing(path) as file:
        figure.savefig(file, format="png", dpi=dpi, metadata={"Software": None})
