"""Styles of the layers of a TIN, in the table ``layer_styles`` from which QGIS takes its defaults.

Triangles have the tints of elevations, lines a color for each kind. A style that a user keeps in
the same table stays, and stays the default.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

from ....terrain.drawing import interpolate_tints
from .schema import LAYERS, NO_CLOCK

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable, Sequence

    from ....tin import TIN

STYLES = "layer_styles"
"""The table of styles, whose name and columns QGIS defines."""

_OWNER = "tinsmith"
_TABLE = (
    f"CREATE TABLE {STYLES} (id INTEGER PRIMARY KEY NOT NULL, f_table_catalog TEXT(256), "
    "f_table_schema TEXT(256), f_table_name TEXT(256), f_geometry_column TEXT(256), "
    "styleName TEXT(30), styleQML TEXT, styleSLD TEXT, useAsDefault BOOLEAN, description TEXT, "
    "owner TEXT(30), ui TEXT(30), update_time DATETIME)"
)
_CONTENT = (
    "INSERT INTO gpkg_contents (table_name, data_type, identifier, description, last_change) "
    f"VALUES ('{STYLES}', 'attributes', '{STYLES}', '', '{NO_CLOCK}')"
)
_COLUMNS = (
    *("f_table_catalog", "f_table_schema", "f_table_name", "f_geometry_column", "styleName"),
    *("styleQML", "styleSLD", "useAsDefault", "description", "owner", "update_time"),
)

_CLASSES = 12
"""Most classes of elevations."""

_ELEVATION = "(z(point_n($geometry, 1)) + z(point_n($geometry, 2)) + z(point_n($geometry, 3))) / 3"
"""Expression of QGIS: the elevation in the middle of a triangle."""

_RED, _ORANGE, _BLUE, _BLACK = (200, 30, 30), (239, 143, 28), (47, 111, 176), (40, 40, 40)
_KINDS = {
    "hard": ("breaklines", _RED, 0.4),
    "soft": ("soft breaklines", _ORANGE, 0.4),
    "boundary": ("boundary", _BLACK, 0.4),
    "hole": ("holes", (120, 120, 120), 0.4),
    "water": ("shores of water", _BLUE, 0.4),
    "": ("other lines", (160, 90, 160), 0.3),
}
"""Label, color and width in millimetres of lines, by their kind."""

_Color = tuple[int, int, int]


def write_styles(file: sqlite3.Connection, tin: TIN) -> None:
    """Write the table, with a row for each layer."""
    made: dict[str, Callable[[TIN], str]] = {
        "triangles": _style_triangles,
        "lines": _style_lines,
        "boundary": lambda _: _style_all(_draw_line(_BLACK, 0.5)),
        "water": lambda _: _style_all(_fill((*_BLUE, 120), _BLUE)),
        "vertices": lambda _: _style_all(_draw_dot()),
    }
    file.execute(_TABLE)
    file.execute(_CONTENT)
    for name in LAYERS:
        row = (name, made[name](tin), f"Made of the TIN by {_OWNER}.", _OWNER, NO_CLOCK)
        file.execute(
            f"INSERT INTO {STYLES} ({', '.join(_COLUMNS)}) "
            f"VALUES ('', '', ?, 'geom', '{_OWNER}', ?, '', 1, ?, ?, ?)",
            row,
        )


def has_foreign_styles(file: sqlite3.Connection) -> bool:
    """Whether a file has styles that tinsmith did not write."""
    columns = _list_columns(file, "main")
    if not set(_COLUMNS) <= columns:
        return bool(columns)
    found = file.execute(f"SELECT 1 FROM {STYLES} WHERE coalesce(owner, '') <> '{_OWNER}'")
    return found.fetchone() is not None


def merge_styles(file: sqlite3.Connection) -> None:
    """Put the styles of the attached file ``made`` among those that are there, in place of ours.

    A table of that name that is none of QGIS stays as it is.
    """
    there = _list_columns(file, "main")
    if not _list_columns(file, "made") or (there and not set(_COLUMNS) <= there):
        return
    if not there:
        file.execute(_TABLE.replace(f"TABLE {STYLES}", f"TABLE main.{STYLES}"))
        file.execute(_CONTENT.replace("INTO gpkg", "INTO main.gpkg"))
    file.execute(f"DELETE FROM main.{STYLES} WHERE owner = '{_OWNER}'")
    chosen = file.execute(f"SELECT f_table_name FROM main.{STYLES} WHERE useAsDefault").fetchall()
    listed, marks = ", ".join(_COLUMNS), ", ".join("?" * len(_COLUMNS))
    for row in file.execute(f"SELECT {listed} FROM made.{STYLES} ORDER BY id").fetchall():
        values = dict(zip(_COLUMNS, row, strict=True))
        values["useAsDefault"] = int((values["f_table_name"],) not in chosen)
        file.execute(f"INSERT INTO main.{STYLES} ({listed}) VALUES ({marks})", [*values.values()])


def _list_columns(file: sqlite3.Connection, schema: str) -> set[str]:
    return {name for _, name, *_ in file.execute(f"PRAGMA {schema}.table_info({STYLES})")}


# ------------------------------------------------------------------- renderers


def _style_triangles(tin: TIN) -> str:
    elevations = tin.points[:, 2]
    limits = _choose_limits(float(elevations.min()), float(elevations.max()))
    unit = "" if tin.elevation_unit is None else tin.elevation_unit.symbol
    ranges, symbols = [], []
    for k, (low, high) in enumerate(zip([-1e300, *limits], [*limits, 1e300], strict=True)):
        color = _mix(k / max(len(limits), 1))
        label = _name_class(limits, k, unit)
        ranges.append(
            f'<range lower="{low!r}" upper="{high!r}" symbol="{k}" '
            f'label={quoteattr(label)} render="true"/>'
        )
        symbols.append(_symbol(k, "fill", _fill(color, color)))
    return _document(
        f'type="graduatedSymbol" attr={quoteattr(_ELEVATION)} graduatedMethod="GraduatedColor"',
        f"<ranges>{''.join(ranges)}</ranges><symbols>{''.join(symbols)}</symbols>",
    )


def _choose_limits(low: float, high: float) -> list[float]:
    """Return round elevations between the lowest and the highest, at most ``_CLASSES - 1``."""
    if not high > low:
        return []
    size = 10.0 ** math.floor(math.log10((high - low) / _CLASSES))
    step = next(
        step for k in (1, 2, 5, 10, 20) if (high - low) / (step := k * size) <= _CLASSES - 1
    )
    first, last = math.floor(low / step) + 1, math.ceil(high / step) - 1
    digits = max(0, -math.floor(math.log10(step)))
    return [round(k * step, digits) for k in range(first, last + 1)]


def _name_class(limits: Sequence[float], k: int, unit: str) -> str:
    if not limits:
        return f"elevation ({unit})" if unit else "elevation"
    if k == 0:
        words = f"below {limits[0]:.15g}"
    elif k == len(limits):
        words = f"above {limits[-1]:.15g}"
    else:
        words = f"{limits[k - 1]:.15g} to {limits[k]:.15g}"
    return f"{words} {unit}".strip()


def _mix(share: float) -> _Color:
    """Return the tint at a share of the ramp."""
    ramp = interpolate_tints()
    r, g, b = ramp[round(share * (len(ramp) - 1))].tolist()
    return r, g, b


def _style_lines(_: TIN) -> str:
    rows = [
        f'<category value="{kind}" symbol="{k}" label="{label}" type="string" render="true"/>'
        for k, (kind, (label, _, _)) in enumerate(_KINDS.items())
    ]
    symbols = [
        _symbol(k, "line", _draw_line(color, width))
        for k, (_, color, width) in enumerate(_KINDS.values())
    ]
    return _document(
        'type="categorizedSymbol" attr="kind"',
        f"<categories>{''.join(rows)}</categories><symbols>{''.join(symbols)}</symbols>",
    )


def _style_all(layer: str) -> str:
    kind = {"SimpleFill": "fill", "SimpleLine": "line", "SimpleMarker": "marker"}
    (shape,) = (shape for name, shape in kind.items() if name in layer)
    return _document('type="singleSymbol"', f"<symbols>{_symbol(0, shape, layer)}</symbols>")


def _document(renderer: str, content: str) -> str:
    return (
        '<!DOCTYPE qgis><qgis version="3.22.0" styleCategories="Symbology">'
        f'<renderer-v2 {renderer} symbollevels="0" forceraster="0" enableorderby="0">'
        f"{content}</renderer-v2></qgis>"
    )


def _symbol(number: int, shape: str, layer: str) -> str:
    return f'<symbol name="{number}" type="{shape}" alpha="1" clip_to_extent="1">{layer}</symbol>'


def _layer(name: str, /, **properties: object) -> str:
    stated = "".join(f'<prop k="{key}" v="{value}"/>' for key, value in properties.items())
    return f'<layer class="{name}" enabled="1" locked="0" pass="0">{stated}</layer>'


def _format(color: Sequence[int]) -> str:
    return ",".join(map(str, (*color, 255)[:4]))


def _fill(color: Sequence[int], outline: Sequence[int]) -> str:
    return _layer(
        "SimpleFill",
        color=_format(color),
        outline_color=_format(outline),
        outline_width="0.1",
        style="solid",
        outline_style="solid",
    )


def _draw_line(color: Sequence[int], width: float) -> str:
    return _layer("SimpleLine", line_color=_format(color), line_width=width, capstyle="round")


def _draw_dot() -> str:
    return _layer(
        "SimpleMarker", name="circle", color="60,60,60,255", size="0.6", outline_style="no"
    )
