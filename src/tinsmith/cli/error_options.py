"""Options of what is measured between two surfaces: errors of both, the level of detection."""

from __future__ import annotations

from typing import Any, get_args

import click

from ..base.policies import CorrelationModel
from .parameters import Decorator, Words, number_option, parsed, under
from .product_options import list_product_options

_SUBJECT = "Errors of elevations"
_MODEL = ("systematic", "other_systematic", "correlation_range", "correlation", "nugget")


@parsed
def _parse_error(_flag: str, value: str) -> float | str:
    """Return a number, or else the name of a column."""
    try:
        return float(value)
    except ValueError:
        return value


def error_options(command: Any) -> Any:
    """Add the options to a command, which gets them by :func:`take_errors`."""
    for option in reversed(under(_SUBJECT, *_list_options())):
        command = option(command)
    return command


def _list_options() -> list[Decorator]:
    words = {
        "level_of_detection": "Difference, in the unit of elevations, up to which the surface "
        "counts as unchanged: the tolerance of a map, told beside the whole volumes.",
        "confidence": "In place of a level: computed from the standard errors, such as 0.95.",
    }
    known = "terrain.earthwork.volumes.volume"
    return [
        click.option(
            "--standard-error",
            metavar="NUMBER|COLUMN",
            callback=_parse_error,
            help="Standard error of the elevations of the first surface, in their unit, or the "
            "column of its points that has it: volumes get standard errors.",
        ),
        click.option(
            "--other-standard-error",
            metavar="NUMBER|COLUMN",
            callback=_parse_error,
            help="The same of the other surface; default exact.",
        ),
        number_option(
            "--systematic", "NUMBER", "Standard error of a shift of the whole first surface."
        ),
        number_option("--other-systematic", "NUMBER", "The same of the other surface."),
        number_option(
            "--correlation-range",
            "LENGTH",
            "Distance, in CRS units, over which errors of points are correlated; default 0, "
            "independent.",
        ),
        click.option(
            "--correlation",
            type=Words(get_args(CorrelationModel)),
            help="How the correlation falls within the range; default exponential.",
        ),
        number_option("--nugget", "SHARE", "Share of the variance that is independent anyway."),
        *list_product_options(known, "level_of_detection confidence", **words),
    ]


def take_errors(asked: dict[str, Any]) -> dict[str, Any]:
    """Take the options out of those of a command, as those of the product that are given."""
    given = {name: asked.pop(name) for name in _MODEL}
    found = {name: asked.pop(name) for name in ("standard_error", "other_standard_error")}
    levels = {name: asked.pop(name) for name in ("level_of_detection", "confidence")}
    shifts = {"standard_error": given.pop("systematic")}
    shifts["other_standard_error"] = given.pop("other_systematic")
    more = {name: value for name, value in given.items() if value is not None}
    if more and all(value is None for value in (*found.values(), *shifts.values())):
        raise click.UsageError(f"{name_flag(next(iter(more)))} needs a --standard-error.")
    return _make_models(found, shifts, more) | {
        name: value for name, value in levels.items() if value is not None
    }


def name_flag(option: str) -> str:
    """Return the flag of an option of the product."""
    return f"--{option.replace('_', '-')}"


def _make_models(
    found: dict[str, Any], shifts: dict[str, float | None], more: dict[str, Any]
) -> dict[str, Any]:
    from ..terrain import ErrorModel

    models = {}
    for name, error in found.items():
        if error is not None or shifts[name] is not None:
            own = 0.0 if error is None else error
            models[name] = ErrorModel(own, systematic=shifts[name] or 0.0, **more)
    return models
