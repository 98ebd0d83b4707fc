"""Temporary files of a run: layers are written for the command as they are."""

from __future__ import annotations

import csv
import json
import re
from dataclasses import dataclass, field
from itertools import chain, count
from pathlib import Path
from typing import Any

from qgis.core import (
    QgsCoordinateTransformContext,
    QgsFeatureRequest,
    QgsJsonUtils,
    QgsProcessingException,
    QgsVectorFileWriter,
    QgsVectorLayer,
)

from .process import CANCELLED

_MOST_LETTERS = 40
"""Of a layer's name in that of a temporary file."""


@dataclass
class Files:
    """Temporary files of one run, and the layers that they stand for.

    Attributes
    ----------
    folder : Path
        Removed at the end of the run.
    names : dict of str to str
        Names of the layers by path, for messages.
    """

    folder: Path
    names: dict[str, str] = field(default_factory=dict)

    def choose_path(self, name: str, suffix: str) -> Path:
        """Return a new path, which is called like a layer."""
        stem = re.sub(r"[^\w -]", "_", name).strip()[:_MOST_LETTERS] or "layer"
        folder = self.folder / str(len(self.names) + 1)
        folder.mkdir()
        path = folder / f"{stem}{suffix}"
        self.names[str(path)] = name
        return path

    def write_source(self, source: Any, feedback: Any) -> Path:
        """Write the features of a source, as they are chosen, with all coordinates and columns.

        A GeoPackage; without a CRS a FlatGeobuf, since GDAL gives a GeoPackage degrees then.
        """
        has_crs = source.sourceCrs().isValid()
        path = self.choose_path(source.sourceName(), ".gpkg" if has_crs else ".fgb")
        in_order = QgsFeatureRequest().addOrderBy("$id")  # a selection has none
        layer = source.materialize(in_order, feedback)
        how = _choose_writing(layer, path.stem, has_crs)
        how.feedback = feedback
        context = QgsCoordinateTransformContext()
        code, said, *_ = QgsVectorFileWriter.writeAsVectorFormatV3(layer, str(path), context, how)
        if feedback.isCanceled():
            raise QgsProcessingException(CANCELLED)
        written = QgsVectorLayer(str(path), "written", "ogr").featureCount()
        if code != QgsVectorFileWriter.NoError or written != layer.featureCount():
            raise QgsProcessingException(
                f"The layer '{source.sourceName()}' cannot be written to a temporary file: "
                f"{said or f'{written:,} of {layer.featureCount():,} features are there'}."
            )
        return path

    def write_table(self, source: Any, feedback: Any) -> Path:
        """Write points as CSV: their coordinates to the last bit, then all columns.

        Raises
        ------
        QgsProcessingException
            If a feature has no point, or more than one.
        """
        path = self.choose_path(source.sourceName(), ".csv")
        in_order = QgsFeatureRequest().addOrderBy("$id")  # a selection has none
        with path.open("w", encoding="utf-8", newline="") as file:
            table = csv.writer(file)
            table.writerow([*name_coordinates(source), *source.fields().names()])
            for feature in source.getFeatures(in_order):
                if feedback.isCanceled():
                    raise QgsProcessingException(CANCELLED)
                geometry = feature.geometry()  # kept while its vertices are asked
                places = list(geometry.vertices())
                if len(places) != 1:
                    raise QgsProcessingException(
                        f"The feature {feature.id()} of the layer '{source.sourceName()}' has "
                        f"{len(places) or 'no'} points, and a row of the table is one point."
                    )
                values = map(_write_value, feature.attributes())
                table.writerow([repr(places[0].x()), repr(places[0].y()), *values])
        return path


def name_coordinates(source: Any) -> list[str]:
    """Return names of the columns of coordinates: x and y, or what the layer has no field of."""
    taken = {one.strip().lower() for one in source.fields().names()}
    return [_choose_name(name, taken) for name in ("x", "y")]


def _choose_name(name: str, taken: set[str]) -> str:
    others = (f"{name}_{k}" for k in count(2))
    return next(one for one in chain([name], others) if one not in taken)


def _write_value(value: Any) -> str:
    """Return a value as the text of a cell: numbers to the last bit, dates and lists as in JSON."""
    if isinstance(value, str):
        return value
    if isinstance(value, float):
        return repr(value)
    text = str(QgsJsonUtils.encodeValue(value))
    if text == "null":
        return ""
    return str(json.loads(text)) if text.startswith('"') else text


def _choose_writing(layer: Any, name: str, has_crs: bool) -> Any:
    """Return how a layer is written: every column but numbers of rows, which may occur twice."""
    how = QgsVectorFileWriter.SaveVectorOptions()
    how.driverName = "GPKG" if has_crs else "FlatGeobuf"
    how.layerName = name
    how.fileEncoding = "UTF-8"
    how.layerOptions = [] if has_crs else ["SPATIAL_INDEX=NO"]  # which would change the order
    columns = layer.fields().names()
    how.attributes = [k for k, column in enumerate(columns) if column.lower() != "fid"]
    how.skipAttributeCreation = not how.attributes
    return how
