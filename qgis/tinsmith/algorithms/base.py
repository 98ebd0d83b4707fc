"""What all algorithms share: parameters become the arguments of the command, which is run."""

from __future__ import annotations

import json
import shlex
import tempfile
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingException,
    QgsProcessingOutputNumber,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterEnum,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterString,
    QgsProcessingParameterVectorDestination,
    QgsProcessingUtils,
)

from ..command import find_command
from ..files import Files
from ..icons import load_icon
from ..inputs import Found, Lines, Place, Surface
from ..options import Option, describe
from ..process import Failed, Speaker, run_program
from ..results import (
    PlaceColumns,
    find_unit,
    load_file,
    name_layer,
    rename_on_loading,
    style_on_loading,
)
from ..styles import style_mesh

EXTRA = "EXTRA"
LOAD = "LOAD"
MESH_FILES = (
    "UGRID mesh (*.nc);;PLY mesh (*.ply);;2DM mesh (*.2dm);;GeoPackage of a whole TIN (*.gpkg);;"
    "LandXML (*.xml);;DXF drawing (*.dxf);;12d Model (*.12da);;IFC (*.ifc);;ADCIRC (*.14);;"
    "SCHISM (*.gr3);;Selafin (*.slf);;Any other (*.*)"
)
TABLE_FILES = "CSV table (*.csv);;JSON table (*.json)"
PICTURES = "PNG picture (*.png)"
REPORTS = "PDF document (*.pdf)"
SHEETS = f"{REPORTS};;SVG pictures (*.svg);;DXF drawing (*.dxf)"


class Run:
    """One run of an algorithm: what is given, where temporary files are, and the command.

    Attributes
    ----------
    algorithm : CommandAlgorithm
    parameters : dict of str to object
    context : QgsProcessingContext
    feedback : QgsProcessingFeedback
    files : Files
    unit : str
        That of elevations, as the last command told it.
    """

    def __init__(
        self,
        algorithm: CommandAlgorithm,
        parameters: dict[str, Any],
        context: Any,
        feedback: Any,
        folder: str,
    ) -> None:
        self.algorithm = algorithm
        self.parameters = parameters
        self.context = context
        self.feedback = feedback
        self.files = Files(Path(folder))
        self.unit = ""
        self._command = find_command()
        version = self._command.find_version()
        feedback.pushInfo(f"{version} ({self._command.path}, {self._command.origin})")

    def list_surface(self, surface: Surface) -> list[str]:
        """Return the file of a surface and the options by which it is to be read."""
        found = self.algorithm.found[surface.name]
        if found is None:
            return []
        return found.list_arguments(
            self.algorithm, self.parameters, self.context, self.files, self.feedback
        )

    def list_tin(self, surface: Surface) -> list[str]:
        """Return the file of a surface that needs no options: its TIN, where it is a layer.

        Options of reading are for all files of a command, so of several surfaces each that needs
        some is read by a command of its own.
        """
        found = self.algorithm.found[surface.name]
        if found is None:
            return []
        path, *options = self.list_surface(surface)
        if found.path and not options:
            return [path]
        name = self.files.names.get(path, Path(path).stem)
        made = str(self.files.choose_path(name, ".gpkg"))
        verb = "convert" if found.is_mesh else "build"
        self.run([verb, path, *options, f"--output={made}"])
        return [made]

    def list_lines(self, lines: tuple[Lines | Place, ...]) -> list[str]:
        """Return the options with the layers of lines and the places that are given, as files."""
        given = (self.algorithm, self.parameters, self.context, self.files, self.feedback)
        return [part for one in lines for part in one.list_arguments(*given)]

    def list_options(self, options: tuple[Option, ...]) -> list[str]:
        """Return the options whose values are given."""
        return [
            part
            for one in options
            for part in one.translate(self.algorithm, self.parameters, self.context)
        ]

    def list_extra(self) -> list[str]:
        """Return further options as the user wrote them."""
        words = self.algorithm.parameterAsString(self.parameters, EXTRA, self.context)
        try:
            return shlex.split(words)
        except ValueError as error:
            raise QgsProcessingException(
                f"More options of the command: {error}: '{words}'."
            ) from error

    def name_output(self, name: str) -> str:
        """Return the path of an output, or nothing if it is not wanted."""
        definition = self.algorithm.parameterDefinition(name)
        if isinstance(definition, QgsProcessingParameterFileDestination):
            return str(self.algorithm.parameterAsFileOutput(self.parameters, name, self.context))
        return str(self.algorithm.parameterAsOutputLayer(self.parameters, name, self.context))

    def list_outputs(self, *names: str) -> tuple[dict[str, str], list[str]]:
        """Return the paths of those outputs that are wanted, and the options that name them."""
        paths = {name: path for name in names if (path := self.name_output(name))}
        return paths, [f"--output={path}" for path in paths.values()]

    def run(self, arguments: list[str]) -> dict[str, Any]:
        """Run the command; return its result."""
        words = [self._command.path, *arguments, "--events", "--json"]
        speaker = Speaker(self.feedback, self.files.names)
        answer = run_program(words, speaker, self.feedback)
        self.feedback.setProgress(100)
        result: dict[str, Any] = json.loads(answer) if answer.strip() else {}
        self.unit = find_unit(result)
        return result


class CommandAlgorithm(QgsProcessingAlgorithm):
    """An algorithm that runs the command.

    Attributes
    ----------
    verb : str
        The command; the algorithm has its name.
    title, summary, explanation : str
        Name, one line, and help.
    surfaces, lines, options : tuple
        What it is given.
    found : dict of str to Found
        Surfaces, once a run has begun.
    """

    verb = ""
    title = ""
    summary = ""
    explanation = ""
    surfaces: tuple[Surface, ...] = ()
    lines: tuple[Lines | Place, ...] = ()
    options: tuple[Option, ...] = ()

    def __init__(self) -> None:
        super().__init__()
        self.found: dict[str, Found | None] = {}
        self._fault: Exception | None = None
        self._to_load: list[Callable[[Any, Any], None]] = []

    # ------------------------------------------------------------ what QGIS asks

    def createInstance(self) -> Any:
        return type(self)()

    def name(self) -> str:
        return self.verb

    def displayName(self) -> str:
        return self.title

    def shortDescription(self) -> str:
        return self.summary

    def shortHelpString(self) -> str:
        paragraphs = (self.summary, self.explanation, f"Runs <code>tinsmith {self.verb}</code>.")
        return "".join(f"<p>{one}</p>" for one in paragraphs)

    def icon(self) -> Any:
        return load_icon(self.name())

    def canExecute(self) -> tuple[bool, str]:
        try:
            find_command()
        except QgsProcessingException as error:
            return False, str(error)
        return True, ""

    # ------------------------------------------------------------ parameters

    def initAlgorithm(self, configuration: Any = None) -> None:
        """Add the parameters: inputs, options, outputs."""
        self.add_inputs()
        for surface in self.surfaces:
            for definition in surface.define():
                self.addParameter(definition)
        for one in self.lines:
            self.addParameter(one.define())
        for option in self.options:
            self.addParameter(option.define())
        extra = QgsProcessingParameterString(
            EXTRA, "More options of the command", None, False, True
        )
        help_text = f"As on the command line: 'tinsmith {self.verb} --help' lists them."
        self.addParameter(describe(extra, help_text, advanced=True))
        self.add_outputs()

    def add_inputs(self) -> None:
        """Add inputs that are neither surfaces nor lines."""

    def add_outputs(self) -> None:
        """Add the outputs."""

    def add_file_output(
        self, name: str, words: str, kinds: str, help_text: str, optional: bool = False
    ) -> None:
        """Add a file as an output; one that is optional is not written unless it is named."""
        made = QgsProcessingParameterFileDestination(
            name, words, kinds, None, optional, not optional
        )
        self.addParameter(describe(made, help_text))

    def add_table_output(self, help_text: str, words: str = "Table") -> None:
        """Add a table as an output that is not written unless it is named."""
        self.add_file_output("TABLE", words, TABLE_FILES, help_text, optional=True)

    def add_layer_output(self, words: str, kind: Any) -> None:
        """Add a vector layer as the output."""
        made = QgsProcessingParameterVectorDestination("OUTPUT", words, kind)
        self.addParameter(describe(made, "GeoPackage, GeoJSON, FlatGeobuf or Shapefile."))

    def add_counts(self) -> None:
        """Add the counts of a TIN, for models."""
        self.add_numbers({"VERTICES": "Vertices", "TRIANGLES": "Triangles"})

    def add_numbers(self, names: dict[str, str]) -> None:
        """Add numbers for models, by their names, with their words."""
        for name, words in names.items():
            self.addOutput(QgsProcessingOutputNumber(name, words))

    def add_mesh_output(self, words: str) -> None:
        """Add a TIN as an output, and whether it is loaded."""
        help_text = (
            "UGRID and PLY keep the CRS and open as mesh layers; of a PLY with breaklines QGIS "
            "colors the breaklines alone. A GeoPackage keeps everything, with styles of its layers."
        )
        self.add_file_output("OUTPUT", words, MESH_FILES, help_text)
        self.add_loading("Load the result as a layer")

    def add_loading(self, words: str) -> None:
        """Add whether outputs that are files are loaded."""
        self.addParameter(
            describe(
                QgsProcessingParameterBoolean(LOAD, words, True),
                "Meshes are colored by elevation.",
            )
        )

    # ------------------------------------------------------------ runs

    def checkParameterValues(self, parameters: dict[str, Any], context: Any) -> tuple[bool, str]:
        found: tuple[bool, str] = super().checkParameterValues(
            self.name_choices(parameters), context
        )
        return found

    def name_choices(self, parameters: dict[str, Any]) -> dict[str, Any]:
        """Return parameters with words for the numbers by which QGIS lists choices."""
        given = dict(parameters)
        for one in self.parameterDefinitions():
            number = str(given.get(one.name()))
            if isinstance(one, QgsProcessingParameterEnum) and number.isdecimal():
                words = one.options()
                if number not in words and int(number) < len(words):
                    given[one.name()] = words[int(number)]
        return given

    def prepareAlgorithm(self, parameters: dict[str, Any], context: Any, feedback: Any) -> bool:
        """Look at the layers, in the main thread, which owns them; QGIS hears of faults later.

        What is raised here it would replace by a general sentence.
        """
        try:
            self.look(parameters, context)
        except QgsProcessingException as error:
            self._fault = error
        return True

    def look(self, parameters: dict[str, Any], context: Any) -> None:
        """Find the surfaces."""
        self.found = {one.name: one.find(self, parameters, context) for one in self.surfaces}

    def processAlgorithm(
        self, parameters: dict[str, Any], context: Any, feedback: Any
    ) -> dict[str, Any]:
        """Run the command in a temporary folder."""
        if self._fault is not None:
            raise self._fault
        root = QgsProcessingUtils.tempFolder()
        with tempfile.TemporaryDirectory(prefix="tinsmith-", dir=root) as folder:
            try:
                run = Run(self, self.name_choices(parameters), context, feedback, folder)
                outputs = self.make(run)
            except Failed as failed:
                raise QgsProcessingException(str(failed)) from failed
        for path in outputs.values():
            rename_on_loading(str(path), run.unit, context)
        return outputs

    def make(self, run: Run) -> dict[str, Any]:
        """Run the command; return the outputs."""
        raise NotImplementedError

    def list_inputs(self, run: Run) -> list[str]:
        """Return all arguments but the outputs, for an algorithm of one surface."""
        return [
            self.verb,
            *run.list_surface(self.surfaces[0]),
            *run.list_lines(self.lines),
            *run.list_options(self.options),
            *run.list_extra(),
        ]

    def postProcessAlgorithm(self, context: Any, feedback: Any) -> dict[str, Any]:
        """Load what Processing does not load itself, in the main thread."""
        for load in self._to_load:
            load(context, feedback)
        return {}

    def load_later(
        self,
        run: Run,
        path: str,
        name: str,
        style: Callable[[Any], None] = style_mesh,
        place: PlaceColumns | None = None,
    ) -> None:
        """Have the output, a file, loaded once the run is over, if the user wants it.

        A mesh gets the style, and a table becomes points where it has columns of coordinates.
        """
        if self.parameterAsBool(run.parameters, LOAD, run.context):
            name = name_layer(path, name, run.unit)
            load = partial(load_file, path, "OUTPUT", name=name, style=style, place=place)
            self._to_load.append(load)

    def run_command(
        self, run: Run, *outputs: str, chosen: Sequence[str] = ()
    ) -> tuple[dict[str, str], dict[str, Any]]:
        """Run the command with all inputs, and options that are ``chosen`` for the user.

        Returns the paths of the outputs that are wanted, and the result of the command.
        """
        paths, named = run.list_outputs(*outputs)
        return paths, run.run([*self.list_inputs(run), *chosen, *named])

    def make_layer(
        self,
        run: Run,
        style: Callable[[Any], None],
        *tables: str,
        chosen: Sequence[str] = (),
    ) -> dict[str, Any]:
        """Run a command that makes a layer, styled once it is loaded, and tables; return these."""
        paths, _ = self.run_command(run, "OUTPUT", *tables, chosen=chosen)
        style_on_loading(paths["OUTPUT"], style, run.context)
        return dict(paths)

    def make_mesh(self, run: Run, name: str, volumes: tuple[str, ...] = ()) -> dict[str, Any]:
        """Run a command that makes a TIN; return the output, its counts and some volumes."""
        paths, record = self.run_command(run, "OUTPUT")
        self.load_later(run, paths["OUTPUT"], name)
        counts = {one.upper(): record["tin"][one] for one in ("vertices", "triangles")}
        return {**paths, **counts, **{one.upper(): record["volume"][one] for one in volumes}}
