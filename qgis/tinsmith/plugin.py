"""The plugin: it registers the provider of algorithms."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsApplication

from .provider import TinsmithProvider


class TinsmithPlugin:
    """What QGIS loads; all it has is the provider."""

    def __init__(self, iface: Any) -> None:
        self.iface = iface
        self.provider: Any = None

    def initProcessing(self) -> None:
        """Register the provider; ``qgis_process`` calls this alone."""
        self.provider = TinsmithProvider()
        QgsApplication.processingRegistry().addProvider(self.provider)

    def initGui(self) -> None:
        """Register the provider when QGIS has a window."""
        self.initProcessing()

    def unload(self) -> None:
        """Take the provider away."""
        QgsApplication.processingRegistry().removeProvider(self.provider)
