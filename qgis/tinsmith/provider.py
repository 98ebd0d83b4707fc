"""The provider: the algorithms, and the setting that names the command."""

from __future__ import annotations

from typing import Any

from processing.core.ProcessingConfig import ProcessingConfig, Setting
from qgis.core import QgsProcessingProvider

from .algorithms import ALGORITHMS
from .command import SETTING
from .icons import load_icon


class TinsmithProvider(QgsProcessingProvider):
    """Algorithms that run the command ``tinsmith``."""

    def id(self) -> str:
        return "tinsmith"

    def name(self) -> str:
        return "Tinsmith"

    def longName(self) -> str:
        return "Tinsmith: exact terrain surfaces (TINs)"

    def icon(self) -> Any:
        return load_icon("tinsmith")

    def load(self) -> bool:
        ProcessingConfig.settingIcons[self.name()] = self.icon()
        words = "Path of the command tinsmith (else that on PATH, else the one installed here)"
        ProcessingConfig.addSetting(
            Setting(self.name(), SETTING, words, "", valuetype=Setting.FILE)
        )
        ProcessingConfig.readSettings()
        self.refreshAlgorithms()
        return True

    def unload(self) -> None:
        ProcessingConfig.removeSetting(SETTING)

    def loadAlgorithms(self) -> None:
        for make in ALGORITHMS:
            self.addAlgorithm(make())

    def supportsNonFileBasedOutput(self) -> bool:
        return False

    def supportedOutputVectorLayerExtensions(self) -> list[str]:
        return ["gpkg", "geojson", "shp", "fgb"]

    def defaultVectorFileExtension(self, hasGeometry: bool = True) -> str:
        return "gpkg"

    def supportedOutputRasterLayerExtensions(self) -> list[str]:
        return ["tif", "asc"]

    def defaultRasterFileExtension(self) -> str:
        return "tif"
