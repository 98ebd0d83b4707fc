"""Figures as small pictures: what the scripts beside this one share."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

from PIL import Image

FOLDER = Path(__file__).parent
SAMPLES = FOLDER.parent.parent / "sample_data"
COLORS = 224


def draw(figure: Any, dpi: int, mode: str = "RGB") -> Image.Image:
    """Return a figure as an image."""
    png = io.BytesIO()
    figure.savefig(png, format="png", dpi=dpi)
    return Image.open(png).convert(mode)


def save(picture: Image.Image, path: Path, colors: int = COLORS) -> None:
    """Write a picture with few colours."""
    picture.quantize(colors, dither=Image.Dither.NONE).save(path, optimize=True)
