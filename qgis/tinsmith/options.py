"""Parameters of algorithms that become options of the command, one for one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from qgis.core import (
    QgsProcessingParameterBoolean,
    QgsProcessingParameterCrs,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterEnum,
    QgsProcessingParameterFile,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)

if TYPE_CHECKING:
    from collections.abc import Callable

AS_IT_SAYS = "as the file or its CRS says"
_UNITS = (AS_IT_SAYS, "m", "ft", "US survey foot")


@dataclass(frozen=True)
class Option:
    """A parameter, and how its value becomes arguments of the command.

    Attributes
    ----------
    define : callable
        Returns the definition, anew for each algorithm, which owns it.
    translate : callable
        Returns the arguments, given the algorithm, the parameters and the context.
    """

    define: Callable[[], Any]
    translate: Callable[[Any, dict[str, Any], Any], list[str]]


def number(
    name: str,
    words: str,
    flag: str,
    help_text: str,
    default: Any = None,
    least: float | None = None,
    integer: bool = False,
    advanced: bool = False,
    required: bool = False,
) -> Option:
    """Return the option for a number; without a default it may be left out unless required."""
    kind = QgsProcessingParameterNumber.Integer if integer else QgsProcessingParameterNumber.Double

    def define() -> Any:
        is_optional = default is None and not required
        made = QgsProcessingParameterNumber(name, words, kind, default, is_optional)
        if least is not None:
            made.setMinimum(least)
        return describe(made, help_text, flag, advanced)

    def translate(algorithm: Any, parameters: dict[str, Any], context: Any) -> list[str]:
        if parameters.get(name) is None:
            return []
        read = algorithm.parameterAsInt if integer else algorithm.parameterAsDouble
        value = read(parameters, name, context)
        return [] if value == default else [f"{flag}={value!r}"]

    return Option(define, translate)


def choice(
    name: str,
    words: str,
    flag: str,
    help_text: str,
    choices: tuple[str, ...],
    advanced: bool = False,
) -> Option:
    """Return the option for one of several words, of which the first is the default."""

    def define() -> Any:
        made = QgsProcessingParameterEnum(name, words, choices, False, choices[0], False, True)
        return describe(made, help_text, flag, advanced)

    def translate(algorithm: Any, parameters: dict[str, Any], context: Any) -> list[str]:
        chosen = algorithm.parameterAsEnumString(parameters, name, context) or choices[0]
        return [] if chosen == choices[0] else [f"{flag}={chosen}"]

    return Option(define, translate)


def switch(name: str, words: str, flag: str, help_text: str, advanced: bool = False) -> Option:
    """Return the option that is on or off."""

    def define() -> Any:
        return describe(
            QgsProcessingParameterBoolean(name, words, False), help_text, flag, advanced
        )

    def translate(algorithm: Any, parameters: dict[str, Any], context: Any) -> list[str]:
        return [flag] if algorithm.parameterAsBool(parameters, name, context) else []

    return Option(define, translate)


def text(name: str, words: str, flag: str, help_text: str, advanced: bool = False) -> Option:
    """Return the option for words, which may be left out."""

    def define() -> Any:
        made = QgsProcessingParameterString(name, words, None, False, True)
        return describe(made, help_text, flag, advanced)

    def translate(algorithm: Any, parameters: dict[str, Any], context: Any) -> list[str]:
        value = algorithm.parameterAsString(parameters, name, context).strip()
        return [f"{flag}={value}"] if value else []

    return Option(define, translate)


def crs(name: str, words: str, flag: str, help_text: str, advanced: bool = False) -> Option:
    """Return the option for a CRS, which may be left out."""

    def define() -> Any:
        return describe(
            QgsProcessingParameterCrs(name, words, None, True), help_text, flag, advanced
        )

    def translate(algorithm: Any, parameters: dict[str, Any], context: Any) -> list[str]:
        chosen = algorithm.parameterAsCrs(parameters, name, context)
        return [f"{flag}={name_crs(chosen)}"] if chosen.isValid() else []

    return Option(define, translate)


def file(name: str, words: str, flag: str, help_text: str, kinds: str) -> Option:
    """Return the option for a file of these kinds, which may be left out."""

    def define() -> Any:
        what = QgsProcessingParameterFile.File, "", None, True, kinds
        return describe(QgsProcessingParameterFile(name, words, *what), help_text, flag)

    def translate(algorithm: Any, parameters: dict[str, Any], context: Any) -> list[str]:
        chosen = algorithm.parameterAsFile(parameters, name, context)
        return [f"{flag}={chosen}"] if chosen else []

    return Option(define, translate)


def interpolation() -> Option:
    """Make the option of how elevations between vertices are found."""
    return choice(
        "METHOD",
        "Between the vertices",
        "--method",
        "linear is the TIN itself; laplace, natural and c1 are smooth.",
        ("linear", "nearest", "laplace", "natural", "c1"),
    )


def elevation_unit() -> Option:
    """Return the option for the unit of elevations."""
    help_text = (
        "Unit of the elevations, where neither the file nor the CRS says. A TIN in metres with "
        "elevations in feet is not the same surface."
    )
    return choice(
        "ELEVATION_UNIT", "Unit of elevations", "--elevation-unit", help_text, _UNITS, advanced=True
    )


def describe(definition: Any, help_text: str, flag: str = "", advanced: bool = False) -> Any:
    """Give a definition its help, which names the option of the command; return it."""
    named = f" In messages: {flag}." if flag else ""
    definition.setHelp(f"{help_text}{named}")
    if advanced:
        hidden = QgsProcessingParameterDefinition.FlagAdvanced
        definition.setFlags(definition.flags() | hidden)
    return definition


def name_crs(chosen: Any) -> str:
    """Return a CRS in the words of the command: its code, or all of it as WKT."""
    code: str = chosen.authid()
    if code and not code.startswith(("USER:", "INTERNAL:")):
        return code
    return str(chosen.toWkt(chosen.WKT_PREFERRED))
