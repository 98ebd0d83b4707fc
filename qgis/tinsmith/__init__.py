"""The command ``tinsmith`` in the Processing toolbox of QGIS."""

from __future__ import annotations

from typing import Any


def classFactory(iface: Any) -> Any:
    """Return the plugin, as QGIS asks for it."""
    from .plugin import TinsmithPlugin

    return TinsmithPlugin(iface)
