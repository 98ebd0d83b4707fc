"""Inputs of algorithms: layers and files become arguments of the command."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from qgis.core import (
    QgsFeature,
    QgsGeometry,
    QgsMeshLayer,
    QgsProcessing,
    QgsProcessingException,
    QgsProcessingFeatureSourceDefinition,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterField,
    QgsProcessingParameterFile,
    QgsProcessingParameterMapLayer,
    QgsProcessingParameterPoint,
    QgsProviderRegistry,
    QgsRasterLayer,
    QgsReferencedPointXY,
    QgsVectorLayer,
    QgsWkbTypes,
)

from .files import Files, name_coordinates
from .options import describe, name_crs
from .results import PlaceColumns

POINTS, POLYGONS = QgsProcessing.TypeVectorPoint, QgsProcessing.TypeVectorPolygon
ANY_FILE = "All files (*)"
"""With names without a dot, too."""


@dataclass(frozen=True)
class Surface:
    """A surface that an algorithm reads: a mesh, points or a DEM as a layer, or any file.

    Attributes
    ----------
    name : str
        Of the parameter of the layer; those of the file and the field begin with it.
    words : str
    is_required : bool
    is_mesh : bool
        Whether it may be a mesh.
    """

    name: str = "INPUT"
    words: str = "Surface"
    is_required: bool = True
    is_mesh: bool = True

    def define(self) -> list[Any]:
        """Return the parameters."""
        kinds = [QgsProcessing.TypeMesh, QgsProcessing.TypeVectorPoint, QgsProcessing.TypeRaster]
        kinds = kinds if self.is_mesh else kinds[1:]
        mesh = "a mesh, " if self.is_mesh else ""
        words = f"{self.words}: {mesh}points or a DEM"
        layer = QgsProcessingParameterMapLayer(self.name, words, None, True, kinds)
        column = QgsProcessingParameterField(
            f"{self.name}_Z_FIELD",
            f"{self.words}: field of elevations, of points without Z",
            None,
            self.name,
            QgsProcessingParameterField.Any,
            False,
            True,
        )
        file = QgsProcessingParameterFile(
            f"{self.name}_FILE",
            f"{self.words}: or a file that is no layer",
            QgsProcessingParameterFile.File,
            "",
            None,
            True,
            ANY_FILE,
        )
        return [
            describe(layer, f"A layer: {mesh}points with Z, or a DEM."),
            describe(column, "Without it the Z of the geometry is taken.", "--z-field"),
            describe(
                file,
                "A TIN (GeoPackage, LandXML, DXF, PLY ...), survey text, lidar, a DEM: for what is "
                "no layer. Its options go to 'More options of the command'.",
            ),
        ]

    def find(self, algorithm: Any, parameters: dict[str, Any], context: Any) -> Found | None:
        """Return what is given; layers are looked at in the main thread.

        Raises
        ------
        QgsProcessingException
            If nothing is given and something must be, or two things are, or a layer is not saved.
        """
        layer = algorithm.parameterAsLayer(parameters, self.name, context)
        file = algorithm.parameterAsFile(parameters, f"{self.name}_FILE", context)
        if parameters.get(self.name) and layer is None:
            raise QgsProcessingException(
                f"'{parameters[self.name]}' is no layer that QGIS opens: a file that tinsmith "
                f"reads is given as {self.name}_FILE."
            )
        if layer is not None and file:
            raise QgsProcessingException(
                f"{self.words}: a layer and a file are given, choose one of them."
            )
        if file:
            return Found(path=file)
        if layer is None:
            if self.is_required:
                raise QgsProcessingException(f"{self.words}: choose a layer or a file.")
            return None
        return _find_layer(layer, self.name)


@dataclass(frozen=True)
class Found:
    """What is given as a surface: a file, a layer's file with its CRS, or a layer to be written."""

    path: str = ""
    source: str = ""
    crs: str = ""
    is_mesh: bool = False

    def list_arguments(
        self, algorithm: Any, parameters: dict[str, Any], context: Any, files: Files, feedback: Any
    ) -> list[str]:
        """Return the file for the command and the options by which it is to be read."""
        if not self.source:
            return [self.path, *([f"--crs={self.crs}"] if self.crs else [])]
        return list_point_arguments(algorithm, parameters, self.source, context, files, feedback)


def list_point_arguments(
    algorithm: Any,
    parameters: dict[str, Any],
    name: str,
    context: Any,
    files: Files,
    feedback: Any,
) -> list[str]:
    """Return the file of a layer of points, and the option that names its elevations.

    Raises
    ------
    QgsProcessingException
        If the layer has no points, or no elevations.
    """
    source = require_features(algorithm, parameters, name, context)
    columns = algorithm.parameterAsFields(parameters, f"{name}_Z_FIELD", context)
    if not columns and not QgsWkbTypes.hasZ(source.wkbType()):
        raise QgsProcessingException(
            f"The layer '{source.sourceName()}' has no Z in its geometry: choose the field that "
            f"holds the elevations ({', '.join(source.fields().names()) or 'it has no fields'})."
        )
    if columns and source.fields().lookupField(columns[0]) < 0:
        raise QgsProcessingException(
            f"The layer '{source.sourceName()}' has no field '{columns[0]}': its fields are "
            f"{', '.join(source.fields().names())}."
        )
    path = files.write_source(source, feedback)
    return [str(path), f"--z-field={columns[0] if columns else 'geometry'}"]


def require_features(algorithm: Any, parameters: dict[str, Any], name: str, context: Any) -> Any:
    """Return a source that has features."""
    source = algorithm.parameterAsSource(parameters, name, context)
    if source is None:
        raise QgsProcessingException(algorithm.invalidSourceError(parameters, name))
    if source.featureCount() == 0:
        chosen = parameters[name]
        is_selection = isinstance(chosen, QgsProcessingFeatureSourceDefinition)
        which = "selected features" if is_selection and chosen.selectedFeaturesOnly else "features"
        raise QgsProcessingException(f"The layer '{source.sourceName()}' has no {which}.")
    return source


def _find_layer(layer: Any, parameter: str) -> Found:
    if isinstance(layer, QgsVectorLayer):
        return Found(source=parameter)
    if isinstance(layer, QgsMeshLayer):
        return Found(path=_locate_mesh(layer), crs=_find_missing_crs(layer), is_mesh=True)
    if isinstance(layer, QgsRasterLayer):
        return Found(path=_locate_file(layer, "gdal"), crs=_find_missing_crs(layer))
    raise QgsProcessingException(f"The layer '{layer.name()}' is no mesh, points or DEM.")


def _locate_mesh(layer: Any) -> str:
    if layer.isEditable() and layer.isModified():
        raise QgsProcessingException(f"The mesh '{layer.name()}' has edits: save them first.")
    return _locate_file(layer, "mdal")


def find_raster(algorithm: Any, parameters: dict[str, Any], name: str, context: Any) -> Found:
    """Return the file of a raster layer; layers are looked at in the main thread."""
    layer = algorithm.parameterAsRasterLayer(parameters, name, context)
    if layer is None:
        raise QgsProcessingException(algorithm.invalidRasterError(parameters, name))
    return _find_layer(layer, name)


def _locate_file(layer: Any, provider: str) -> str:
    """Return the file of a layer that comes from one."""
    path = QgsProviderRegistry.instance().decodeUri(provider, layer.source()).get("path", "")
    if layer.dataProvider().name() != provider or not Path(path).is_file():
        raise QgsProcessingException(f"The layer '{layer.name()}' is no file: save it first.")
    return str(path)


def _find_missing_crs(layer: Any) -> str:
    """Return the CRS that the user has given to a layer whose file names none."""
    own, chosen = layer.dataProvider().crs(), layer.crs()
    if own.isValid() and chosen != own:
        raise QgsProcessingException(
            f"The layer '{layer.name()}' is taken to be in {chosen.authid() or 'no CRS'}, and its "
            f"file says {own.authid() or own.description()}: correct the file, or the layer's CRS."
        )
    return name_crs(chosen) if chosen.isValid() and not own.isValid() else ""


@dataclass(frozen=True)
class Lines:
    """A layer of lines, or of polygons or points, that the command reads by an option."""

    name: str
    words: str
    flag: str
    help_text: str
    kind: Any = QgsProcessing.TypeVectorLine
    required: bool = False
    advanced: bool = False

    def define(self) -> Any:
        """Return the parameter."""
        made = QgsProcessingParameterFeatureSource(
            self.name, self.words, [self.kind], None, not self.required
        )
        return describe(made, self.help_text, self.flag, self.advanced)

    def list_arguments(
        self, algorithm: Any, parameters: dict[str, Any], context: Any, files: Files, feedback: Any
    ) -> list[str]:
        """Return the option with the layer as a file, if one is given."""
        if not parameters.get(self.name):
            return []
        source = require_features(algorithm, parameters, self.name, context)
        return [f"{self.flag}={files.write_source(source, feedback)}"]


@dataclass(frozen=True)
class PointTable(Lines):
    """A layer of points, which the command reads as a CSV file."""

    kind: Any = POINTS

    def list_arguments(
        self, algorithm: Any, parameters: dict[str, Any], context: Any, files: Files, feedback: Any
    ) -> list[str]:
        """Return the options with the table and with the CRS of the layer, if one is given."""
        place = self.find_place(algorithm, parameters, context)
        if place is None:
            return []
        source = require_features(algorithm, parameters, self.name, context)
        chosen = [f"{self.flag}-columns", place.x, place.y, f"{self.flag}-delimiter=,"]
        if place.crs.isValid():
            chosen.append(f"{self.flag}-crs={name_crs(place.crs)}")
        return [f"{self.flag}={files.write_table(source, feedback)}", *chosen]

    def find_place(
        self, algorithm: Any, parameters: dict[str, Any], context: Any
    ) -> PlaceColumns | None:
        """Return the columns of coordinates that the table has, if a layer is given."""
        if not parameters.get(self.name):
            return None
        source = require_features(algorithm, parameters, self.name, context)
        x, y = name_coordinates(source)
        return PlaceColumns(x, y, source.sourceCrs())


@dataclass(frozen=True)
class Place:
    """A point that is clicked on the map or typed, which the command reads by an option.

    Attributes
    ----------
    flag : str
        Takes a file of points, with their CRS.
    plain_flag : str
        Takes two coordinates in the CRS of the surface: for those without a CRS.
    """

    name: str
    words: str
    flag: str
    plain_flag: str
    help_text: str

    def define(self) -> Any:
        """Return the parameter."""
        return describe(
            QgsProcessingParameterPoint(self.name, self.words), self.help_text, self.flag
        )

    def list_arguments(
        self, algorithm: Any, parameters: dict[str, Any], context: Any, files: Files, feedback: Any
    ) -> list[str]:
        """Return the option with the place."""
        place = algorithm.parameterAsPoint(parameters, self.name, context)
        given = parameters.get(self.name)
        if not isinstance(given, QgsReferencedPointXY) and "[" not in str(given):
            return [self.plain_flag, repr(place.x()), repr(place.y())]
        layer = QgsVectorLayer("Point", self.words, "memory")
        layer.setCrs(algorithm.parameterAsPointCrs(parameters, self.name, context))
        feature = QgsFeature()
        feature.setGeometry(QgsGeometry.fromPointXY(place))
        layer.dataProvider().addFeatures([feature])
        return [f"{self.flag}={files.write_source(layer, feedback)}"]
