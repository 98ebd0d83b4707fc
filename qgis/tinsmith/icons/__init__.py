"""Icons, drawn as SVG."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from qgis.PyQt.QtGui import QIcon


def load_icon(name: str) -> Any:
    """Return the icon of an algorithm, or that of the plugin."""
    folder = Path(__file__).parent
    path = folder / f"{name}.svg"
    return QIcon(str(path if path.exists() else folder / "tinsmith.svg"))
