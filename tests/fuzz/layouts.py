"""A campaign: tables of survey exports of many countries, whose points and meaning are known.

Each case is labelled by how it is made: `plain` is read by a person without asking, `doubtful` can
be read in two ways, `contradictory` says two things, or nothing that is a point. What is read must
be the points that were written; a `doubtful` one may be refused, a `contradictory` one mostly must.
"""

from __future__ import annotations

import re
import tempfile
import warnings
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pyproj

import tinsmith as ts

from .campaign import Campaign, Case
from .layout_places import PLACES, Place
from .layout_words import (
    ANGLES,
    AXES,
    EXTRAS,
    FOREIGN_HEIGHTS,
    FOREIGN_PLACES,
    NORTH_AXES,
    ORDERS,
    SECOND_PAIRS,
    TITLES,
    WORDS,
    Group,
)

CODES = ("GS", "EP", "TREE", "BLDG CNR", "CL 2", "Weg", "mur", "borde", "MH", "top of bank", "塀")
ORDER = ("PENZD", "PENZD", "PNEZD", "PNEZD", "PENZ", "PNEZ", "ENZ", "NEZ", "ENZD", "NEZD", "PDENZ")
BARE_ORDER = ("PNEZD", "PENZD", "PNEZD", "PENZD", "PNEZ", "PENZ")
LETTERS = ("P", "E", "N", "Z", "D")
ENGLISH = {
    "P": ("point", "number", "Pt", "Point", "ID"),
    "E": ("easting", "Easting", "EASTING", "East", "E"),
    "N": ("northing", "Northing", "NORTHING", "North", "N"),
    "Z": ("elevation", "Elevation", "ELEVATION", "Elev", "Z"),
    "D": ("description", "Code", "DESCRIPTION", "Desc", "D"),
}
FACTORS = {"": None, "m": 1.0, "ft": 0.3048, "ftUS": 1200 / 3937, "mm": 0.001}
UNIT_WORDS = {
    "m": ("m", "m", "m", "metres", "meters"),
    "ftUS": ("USft", "US survey feet", "usft", "ftUS", "sft"),
    "ft": ("ift", "international feet", "int ft"),
}
WGS84_GRIDS = ("EPSG:326", "EPSG:327", "EPSG:25832", "EPSG:25830", "EPSG:3006", "EPSG:2154")
MARGIN = 2.5
"""Degrees that the area of use is widened by, before a point counts as outside."""


def choose(rng: np.random.Generator, items: Any) -> Any:
    return items[int(rng.integers(len(items)))]


def happens(rng: np.random.Generator, share: float) -> bool:
    return bool(rng.random() < share)


# ------------------------------------------------------------------ places


@cache
def is_decided(crs: str, easting: float, northing: float) -> bool:
    """Whether the point with easting and northing exchanged lies outside the area of use."""
    frame = pyproj.CRS(crs)
    area = frame.area_of_use
    transform = pyproj.Transformer.from_crs(frame, "EPSG:4326", always_xy=True).transform
    lon, lat = transform(northing, easting)
    inside_lon = area.west - MARGIN <= lon <= area.east + MARGIN
    return not (inside_lon and area.south - MARGIN <= lat <= area.north + MARGIN)


@cache
def names_north_x(crs: str) -> bool:
    """Whether the definition of the CRS calls its northing X."""
    axes = pyproj.CRS(crs).axis_info
    return any(axis.abbrev.upper() == "X" and axis.direction == "north" for axis in axes)


@cache
def degrees_of(crs: str) -> Any:
    return pyproj.Transformer.from_crs(crs, "EPSG:4326", always_xy=True).transform


def is_certain(place: Place) -> bool:
    """Whether the CRS tells easting and northing apart by where the points lie."""
    return place.crs is not None and is_decided(place.crs, *place.point[:2])


def pick_place(rng: np.random.Generator, which: Any = lambda place: True) -> Place:
    found: Place = choose(rng, [place for place in PLACES.values() if which(place)])
    return found


# ------------------------------------------------------------------ a table


def make_points(rng: np.random.Generator, place: Place, digits: int) -> list[list[float]]:
    count = int(rng.integers(5, 26))
    spread = np.column_stack([180 * rng.random(count), 140 * rng.random(count),
                              6 * rng.random(count)])  # fmt: skip
    rows = (np.array(place.point) + spread).tolist()
    return [[float(f"{value:.{digits}f}") for value in row] for row in rows]


def make_numbers(rng: np.random.Generator, count: int, *, is_whole: bool) -> list[str]:
    kind = int(rng.integers(3 if is_whole else 6))
    start = int(choose(rng, (1, 1, 101, 5_001)))
    given = np.arange(start, start + count)
    if kind == 1:
        given = given + np.cumsum(rng.integers(0, 3, count))
    prefix = {3: "P", 4: "ST-", 5: "A1."}.get(kind, "")
    return [f"{prefix}{one}" for one in given]


def make_table(rng: np.random.Generator, place: Place, *, is_bare: bool = False) -> Case:
    """Return a case with points in a place and marks of its language, yet without columns."""
    digits = 3 if happens(rng, 0.8) else 2
    points = make_points(rng, place, digits)
    separator = choose(rng, (",", ",", ",", ";", ";", "\t", "\t", " ", "|"))
    is_european = not set(place.languages.split()) & {"en", "ja", "zh", "zh-tw", "ko", "th", "he"}
    decimal = "," if separator in ";\t" and is_european and happens(rng, 0.6) else "."
    codes = CODES if separator != " " else [code for code in CODES if " " not in code]
    given = place.crs is not None and happens(rng, 0.7)
    return {
        "label": "plain",
        "what": "",
        "points": points,
        "number": make_numbers(rng, len(points), is_whole=is_bare),
        "code": [choose(rng, codes) for _ in points],
        "columns": [],
        "extra": [],
        "above": [],
        "units": [],
        "below": [],
        "repeat_at": 0,
        "separator": separator,
        "decimal": decimal,
        "minus": "\u2212" if happens(rng, 0.2) else "-",
        "digits": digits,
        "suffix": choose(rng, (".csv", ".txt", ".txt", ".asc", ".xyz")),
        "newline": choose(rng, ("\n", "\n", "\r\n")),
        "bom": happens(rng, 0.15),
        "pad": separator in ",;|" and happens(rng, 0.1),
        "ends": separator in ";," and happens(rng, 0.06),
        "crs": place.crs if given else None,
        "unit": "",
        "angle": False,
        "truth": "points",
        "told": "",
    }


def arrange(rng: np.random.Generator, case: Case, group: Group, order: str) -> None:
    """Give the columns of an order their names."""
    names = dict(zip(LETTERS, group, strict=True))
    case["columns"] = [[letter, names[letter]] for letter in order]
    if case["separator"] == " ":
        case["columns"] = [[letter, re.sub(r"\s", "_", name)] for letter, name in case["columns"]]


def add_extras(rng: np.random.Generator, case: Case) -> None:
    """Put columns beside the coordinates that are none."""
    for _ in range(int(choose(rng, (0, 0, 0, 1, 1, 2, 3)))):
        kind = choose(rng, tuple(EXTRAS))
        name = choose(rng, [one for one in EXTRAS[kind] if is_spoken(one, case)])
        if any(name == other for _, other in case["columns"]):
            continue
        if case["separator"] == " ":
            name = name.replace(" ", "_")
        cells = [extra_cell(rng, kind, row) for row in range(len(case["points"]))]
        at = len(case["columns"]) if happens(rng, 0.7) else int(rng.integers(1, 3))
        case["columns"].insert(at, [f"A{len(case['extra'])}", name])
        case["extra"].append(cells)


def is_spoken(names: Any, case: Case) -> bool:
    """Whether names are in English, or in the letters of the names that are there."""
    here = "".join(name for _, name in case["columns"])
    text = "".join(names)
    scripts = {ord(letter) >> 8 for letter in here if not letter.isascii()}
    return text.isascii() or {ord(letter) >> 8 for letter in text if ord(letter) > 255} <= scripts


def extra_cell(rng: np.random.Generator, kind: str, row: int) -> str:
    return {
        "small": f"{0.005 + 0.03 * rng.random():.3f}",
        "rod": "1.800",
        "geoid": f"{47.1 + 0.01 * row:.3f}",
        "date": f"2026-05-{1 + row % 28:02d}",
        "count": str(int(rng.integers(1, 20))),
        "text": str(choose(rng, ("Fixed", "RTK", "FIX", "JMK"))),
        "attribute": f"{10 * rng.random():.2f}",
    }[kind]


def add_second_pair(rng: np.random.Generator, case: Case, place: Place) -> None:
    """Put the coordinates of the same points in WGS 84 beside them."""
    lat, lon, height = choose(rng, [pair for pair in SECOND_PAIRS if is_spoken(pair, case)])
    found = np.array([degrees_of(place.crs)(e, n) for e, n, _ in case["points"]])
    heights = np.array(case["points"])[:, 2] + 41.7
    values = (found[:, 1], found[:, 0], heights)
    for name, cells, digits in zip((lat, lon, height), values, (9, 9, 3), strict=True):
        case["columns"].append([f"A{len(case['extra'])}", name])
        case["extra"].append([f"{value:.{digits}f}" for value in cells])


def decorate(rng: np.random.Generator, case: Case, place: Place) -> None:
    """Put units, zone, datum and capitals to the names, as exports do."""
    unit = choose(rng, UNIT_WORDS[place.unit])
    style = choose(rng, ("", "", "", "({})", "[{}]", "_{}", " ({})", " [{}]", " / {}"))
    is_blank = case["separator"] == " "
    if is_blank and (" " in style or " " in unit):
        style = ""
    zone = choose(rng, ("", "", "", "", " ({})", " {}", "_{}"))
    for column in case["columns"]:
        letter, name = column
        has_unit = letter in "ENZ" and style and not name.endswith(("]", ")"))
        where = place.datum if letter == "Z" else place.zone if letter in "EN" else ""
        if where and zone and not is_blank and where.split()[0] not in name:
            name += zone.format(where)
        column[1] = name + style.format(unit) if has_unit else name
        case["unit"] = place.unit if has_unit and letter == "Z" else case["unit"]
    case_of = choose(rng, (str, str, str, str.upper, str.lower))
    if place.languages.split()[0] not in ("tr", "el"):
        case["columns"] = [[letter, case_of(name)] for letter, name in case["columns"]]


def add_units_below(rng: np.random.Generator, case: Case, place: Place) -> None:
    """Put a line of units below the header."""
    if case["unit"] or case["separator"] == " " or case["ends"]:
        return
    word = choose(rng, UNIT_WORDS[place.unit])
    style = choose(rng, ("{}", "[{}]", "({})"))
    case["units"] = [style.format(word) if letter in "ENZ" else "" for letter, _ in case["columns"]]
    case["unit"] = place.unit


def surround(rng: np.random.Generator, case: Case) -> None:
    """Put titles above the table, and ends below it."""
    for _ in range(int(choose(rng, (0, 0, 0, 1, 2, 3)))):
        prefix = choose(rng, ("# ", "// ", "", "; ", "# "))
        job = choose(rng, ("A7 Nord", "Site 12", "Mill Lane", "Umgehung"))
        case["above"].append(prefix + choose(rng, TITLES).format(job=job))
    if happens(rng, 0.07):
        case["below"].append(choose(rng, ("END", "EOF", "end", "# end of file", "END OF FILE")))
    if happens(rng, 0.1):
        case["below"] += [""] * 2
    if case["columns"] and happens(rng, 0.06):
        case["repeat_at"] = len(case["points"]) // 2


# ------------------------------------------------------------------ plain


def header_of_words(rng: np.random.Generator) -> Case:
    place = pick_place(rng)
    language = choose(rng, place.languages.split())
    case = make_table(rng, place)
    arrange(rng, case, choose(rng, WORDS[language]), choose(rng, ORDER))
    finish(rng, case, place)
    return case | {"what": f"words, {language}"}


def finish(rng: np.random.Generator, case: Case, place: Place) -> None:
    if place.crs is not None and happens(rng, 0.12) and case["separator"] != " ":
        add_second_pair(rng, case, place)
    decorate(rng, case, place)
    add_extras(rng, case)
    if happens(rng, 0.1):
        add_units_below(rng, case, place)
    surround(rng, case)


def header_of_axes(rng: np.random.Generator) -> Case:
    """Make a header of X and Y where X is the easting, as the country has it."""
    place = pick_place(
        rng, lambda one: not one.x_is_north and set(one.languages.split()) & AXES.keys()
    )
    language = choose(rng, [one for one in place.languages.split() if one in AXES])
    case = make_table(rng, place)
    order = choose(rng, ("PENZD", "PENZD", "PENZ", "ENZ", "ENZD"))
    arrange(rng, case, choose(rng, AXES[language]), order)
    finish(rng, case, place)
    return case | {"what": f"axes, {language}"}


def header_of_north_axes(rng: np.random.Generator) -> Case:
    """Make a header whose X is the northing, where the CRS says so or the points can only be so."""
    place = pick_place(
        rng, lambda one: one.x_is_north and (is_certain(one) or names_north_x(one.crs))
    )
    case = make_table(rng, place) | {"crs": place.crs}
    language = place.languages
    order = choose(rng, ("PENZD", "PNEZD", "PENZ", "PNEZ", "NEZ", "ENZ"))
    arrange(rng, case, choose(rng, NORTH_AXES[language]), order)
    finish(rng, case, place)
    return case | {"what": f"north axes, {language}"}


def header_of_twins(rng: np.random.Generator) -> Case:
    """Make a header with both kinds of names: X (Northing)."""
    place = pick_place(rng, lambda one: WORDS.keys() & set(one.languages.split()))
    language = choose(rng, place.languages.split())
    number, east, north, height, code = choose(rng, WORDS[language])
    if {"X", "Y"} & set(f"{east} {north}".upper().split()):
        east, north = "E", "N"
    style = choose(rng, ("{axis} ({word})", "{axis} [{word}]", "{word} ({axis})", "{word} {axis}",
                         "{axis}({word})", "{word}_{axis}"))  # fmt: skip
    axes = ("Y", "X") if place.x_is_north or happens(rng, 0.3) else ("X", "Y")
    east, north = (
        style.format(axis=axis, word=word) for axis, word in zip(axes, (east, north), strict=True)
    )
    case = make_table(rng, place)
    arrange(rng, case, (number, east, north, height, code), choose(rng, ORDER))
    if case["separator"] == " ":
        case["separator"] = "\t"
    add_extras(rng, case)
    surround(rng, case)
    return case | {"what": f"twins, {language}"}


def header_of_angles(rng: np.random.Generator) -> Case:
    """Make a header of longitude and latitude."""
    place = pick_place(rng, lambda one: str(one.crs).startswith(WGS84_GRIDS))
    language = choose(rng, place.languages.split())
    names = choose(rng, ANGLES.get(language, ANGLES["en"]))
    number, _, _, height, code = choose(rng, WORDS[language])
    case = make_table(rng, place) | {"crs": place.crs, "angle": True, "minus": "-"}
    arrange(rng, case, (number, *names, height, code), choose(rng, ("PENZD", "PNEZD", "NEZ")))
    surround(rng, case)
    return case | {"what": f"angles, {language}"}


def no_header(rng: np.random.Generator) -> Case:
    """Make a table without a header, in a CRS that tells northing from easting."""
    place = pick_place(rng, is_certain)
    case = make_table(rng, place, is_bare=True) | {"crs": place.crs}
    order = choose(rng, BARE_ORDER)
    case["columns"] = [[letter, ""] for letter in order]
    case["above"] = [f"# {choose(rng, TITLES).format(job='A7')}"] if happens(rng, 0.2) else []
    return case | {"what": "no header"}


def order_above(rng: np.random.Generator) -> Case:
    """Make a table whose order stands in a line above it."""
    place = pick_place(rng)
    case = make_table(rng, place, is_bare=True)
    order = choose(rng, ("PNEZD", "PENZD", "NEZ", "NEZ", "ENZ", "PNEZ", "NEZD"))
    case["columns"] = [[letter, ""] for letter in order]
    line = order_line(rng, order, case["separator"])
    case["above"] = [line, *(["# 3 m grid"] if happens(rng, 0.05) else [])]
    if happens(rng, 0.3):
        case["above"].insert(0, "# " + choose(rng, TITLES).format(job="A7"))
    return case | {"what": f"order above: {line}"}


def order_line(rng: np.random.Generator, order: str, separator: str) -> str:
    style = int(rng.integers(len(ENGLISH["E"]) - 1))
    words = [ENGLISH[letter][style] for letter in order]
    short = dict(zip("enz", ("E", "N", "Z"), strict=True))
    pattern = choose(rng, ORDERS)
    if "{n}" in pattern and order not in ("NEZ",):
        pattern = "# {full}"
    joined = choose(rng, (" ", ", ", ",", "/", "-")).join(words)
    return str(pattern.format(letters=order, words=joined, full=separator.join(words), **short))


PLAIN = (
    *(header_of_words,) * 8, *(header_of_axes,) * 3, *(header_of_north_axes,) * 2,
    header_of_twins, header_of_angles, no_header, order_above,
)  # fmt: skip


# ------------------------------------------------------------------ doubtful


def bare_and_lost(rng: np.random.Generator) -> Case:
    """Make a table without a header and without a CRS that tells."""
    place = pick_place(rng)
    case = make_table(rng, place, is_bare=True)
    if is_certain(place):
        case["crs"] = None
    case["columns"] = [[letter, ""] for letter in choose(rng, (*BARE_ORDER, "NEZD", "ENZD"))]
    return case | {"what": "neither header nor CRS", "told": r"convention|No header"}


def list_of_numbers(rng: np.random.Generator) -> Case:
    """Make rows that begin with a chainage, a time or a decimal number, without a header."""
    case = make_table(rng, pick_place(rng), is_bare=True)
    count = len(case["points"])
    firsts = choose(rng, (
        [f"{20 * i}.00" for i in range(count)],
        [f"{432_000.5 + 3.25 * i:.2f}" for i in range(count)],
        [f"{100 + i // 5}.{i % 5 + 1}" for i in range(count)],
        [str(count - i) for i in range(count)],
        [str(10 * i + 10) for i in range(count)],
    ))  # fmt: skip
    case["extra"] = [firsts]
    order = choose(rng, (("A0", "E", "N", "Z"), ("A0", "N", "E", "Z"), ("A0", "E", "N")))
    case["columns"] = [[letter, ""] for letter in order]
    return case | {"what": "a list of numbers first", "truth": "points" if "Z" in order else ""}


def north_axes_alone(rng: np.random.Generator) -> Case:
    """Make a header whose X is the northing, without anything that says so."""
    place = pick_place(rng, lambda one: one.x_is_north)
    case = make_table(rng, place) | {"crs": None}
    group = choose(rng, NORTH_AXES[place.languages])
    arrange(rng, case, group, choose(rng, ("PENZD", "PENZ")))
    return case | {"what": "X may be the northing", "told": "X"}


def unknown_bracket(rng: np.random.Generator) -> Case:
    """Make a header with a word beside a coordinate that may mean anything."""
    place = pick_place(rng)
    case = make_table(rng, place)
    arrange(rng, case, choose(rng, WORDS[choose(rng, place.languages.split())]), choose(rng, ORDER))
    word = choose(rng, ("old", "new", "A", "2", "calc", "rev B", "adj", "approx", "x", "temp", "?"))
    at = choose(rng, [i for i, (letter, _) in enumerate(case["columns"]) if letter in "ENZ"])
    case["columns"][at][1] += f"({word})"
    return case | {"what": f"({word})"}


def two_systems(rng: np.random.Generator) -> Case:
    """Make a header with two sets of coordinates, one of them local."""
    place = pick_place(rng, lambda one: one.crs is not None)
    case = make_table(rng, place)
    group = choose(rng, WORDS["en"][:3])
    arrange(rng, case, group, choose(rng, ("PENZD", "PNEZ")))
    names = choose(rng, (
        ("X", "Y", "Z"), ("x", "y", "z"), ("Local E", "Local N", "Local H"), ("E2", "N2", "H2"),
        ("Easting (local)", "Northing (local)", "Elevation (local)"),
        ("X local", "Y local", "Z local"), ("Plant E", "Plant N", "Plant El"),
    ))  # fmt: skip
    if case["separator"] == " ":
        case["separator"] = ","
    at = choose(rng, (1, len(case["columns"])))
    for name, first in zip(names, (100, 200, 5), strict=True):
        cells = [f"{first + 9 * rng.random():.3f}" for _ in case["points"]]
        case["columns"].insert(at, [f"A{len(case['extra'])}", name])
        case["extra"].append(cells)
        at += 1
    return case | {"what": f"two systems: {names[0]}"}


def feet_in_a_comment(rng: np.random.Generator) -> Case:
    """Make a table whose unit stands in a line above it."""
    place = pick_place(rng, lambda one: one.unit == "m")
    case = make_table(rng, place)
    arrange(rng, case, choose(rng, WORDS["en"]), choose(rng, ORDER))
    case["above"] = [choose(rng, (
        "# elevations in US survey feet", "# Elevations: feet", "Vertical unit: US survey foot",
        "# heights in ft", "Elevation units: international feet", "# vertical datum NAVD88 (ft)",
        "Units: US Feet", "# units = feet",
    ))]  # fmt: skip
    return case | {"what": "feet above", "unit": "ft", "told": r"(?i)feet|foot|ft\b"}


def mixed_languages(rng: np.random.Generator) -> Case:
    """Make a header whose words are of several languages."""
    place = pick_place(rng)
    case = make_table(rng, place)
    found = [choose(rng, WORDS[choose(rng, tuple(WORDS))]) for _ in LETTERS]
    if any(re.search(r"\b[XYN]\b", one[k]) for k, one in enumerate(found)):
        found = [WORDS["en"][0]] * len(LETTERS)
    arrange(rng, case, tuple(one[k] for k, one in enumerate(found)), choose(rng, ORDER))
    return case | {"what": "several languages"}


def order_of_fewer(rng: np.random.Generator) -> Case:
    """Make a table whose order stands above it, and names all columns but the last."""
    place = pick_place(rng)
    case = make_table(rng, place, is_bare=True)
    order = choose(rng, ("NEZ", "ENZ", "PNEZ", "PENZ"))
    case["columns"] = [[letter, ""] for letter in order]
    case["columns"].append(["A0", ""])
    case["extra"] = [[str(int(rng.integers(1, 30))) for _ in case["points"]]]
    case["above"] = [order_line(rng, order, case["separator"])]
    return case | {"what": f"order of fewer: {case['above'][0]}"}


DOUBTFUL = (
    order_of_fewer,
    bare_and_lost, list_of_numbers, north_axes_alone, unknown_bracket, two_systems,
    feet_in_a_comment, mixed_languages,
)  # fmt: skip


# ------------------------------------------------------------------ contradictory


def foreign_height(rng: np.random.Generator) -> Case:
    """Make a header whose only height is none of the points, or not as it stands."""
    place = pick_place(rng)
    case = make_table(rng, place)
    group = choose(rng, WORDS[choose(rng, place.languages.split())])
    name = choose(rng, FOREIGN_HEIGHTS)
    arrange(rng, case, (*group[:3], name, group[4]), choose(rng, ORDER))
    return case | {"what": f"height: {name}", "truth": ""}


def foreign_place(rng: np.random.Generator) -> Case:
    """Make a header whose eastings and northings are no eastings and northings."""
    place = pick_place(rng)
    case = make_table(rng, place)
    number, _, _, height, code = choose(rng, WORDS[choose(rng, place.languages.split())])
    pair = choose(rng, FOREIGN_PLACES)
    arrange(rng, case, (number, *pair, height, code), choose(rng, ORDER))
    return case | {"what": f"place: {pair[0]}", "truth": "", "told": "millimetre|kilometre"}


def exchanged_names(rng: np.random.Generator) -> Case:
    """Make a header that calls eastings northings, where the CRS tells."""
    place = pick_place(rng, is_certain)
    case = make_table(rng, place) | {"crs": place.crs}
    group = choose(rng, WORDS[choose(rng, place.languages.split())])
    if re.search(r"\b[XY]\b", group[1]):
        group = WORDS["en"][0]
    arrange(rng, case, (group[0], group[2], group[1], *group[3:]), choose(rng, ORDER))
    return case | {"what": "exchanged names"}


def unit_of_another(rng: np.random.Generator) -> Case:
    """Make a header whose eastings are in feet, under a CRS in metres."""
    place = pick_place(rng, lambda one: one.unit == "m" and one.crs is not None)
    case = make_table(rng, place) | {"crs": place.crs}
    arrange(rng, case, choose(rng, WORDS["en"]), choose(rng, ORDER))
    unit = choose(rng, ("ft", "US ft", "feet", "USft", "mm", "km"))
    for column in case["columns"]:
        column[1] += f"({unit})" if column[0] in "EN" else ""
    return case | {"what": f"unit {unit}", "truth": ""}


def order_against_header(rng: np.random.Generator) -> Case:
    """Make a header, and a line above that names another order."""
    place = pick_place(rng)
    case = make_table(rng, place)
    order, other = choose(rng, (("ENZ", "NEZ"), ("NEZ", "ENZ"), ("PENZ", "PNEZ")))
    arrange(rng, case, choose(rng, WORDS["en"]), order)
    words = " ".join(ENGLISH[letter][1] for letter in other)
    case["above"] = [choose(rng, (f"# order: {words}", f"# columns: {words}", f"# {words}"))]
    return case | {"what": "order against header", "told": r"order|line 1|header|above"}


def order_against_crs(rng: np.random.Generator) -> Case:
    """Make a table whose order stands above it, and cannot be."""
    place = pick_place(rng, is_certain)
    case = make_table(rng, place, is_bare=True) | {"crs": place.crs}
    case["columns"] = [[letter, ""] for letter in "ENZ"]
    case["above"] = [order_line(rng, "NEZ", case["separator"])]
    return case | {"what": f"order against CRS: {case['above'][0]}"}


def turned_angles(rng: np.random.Generator) -> Case:
    """Make longitudes whose hemisphere or form stands in the name."""
    place = pick_place(rng, lambda one: str(one.crs).startswith(WGS84_GRIDS))
    case = make_table(rng, place) | {"crs": place.crs, "angle": True, "minus": "-"}
    names = choose(rng, (
        ("Longitude (W)", "Latitude"), ("Lon (West)", "Lat"), ("Longitude", "Latitude (S)"),
        ("Lon (DMS)", "Lat (DMS)"), ("Lon (rad)", "Lat (rad)"), ("Lon (gon)", "Lat (gon)"),
        ("West Longitude", "Latitude"), ("Länge (West)", "Breite"), ("Longitud (O)", "Latitud (S)"),
        ("Lon (DDMM.mm)", "Lat (DDMM.mm)"), ("Longitude (grads)", "Latitude (grads)"),
        ("-Lon", "Lat"), ("Longitude*-1", "Latitude"), ("Lon (arcsec)", "Lat (arcsec)"),
    ))  # fmt: skip
    arrange(rng, case, ("Pt", *names, "Elevation", "Code"), choose(rng, ("PNEZD", "PENZ", "NEZ")))
    return case | {"what": f"angles: {names[0]}", "truth": ""}


def hemispheres(rng: np.random.Generator) -> Case:
    """Make longitudes and latitudes without a sign, and columns for the hemispheres."""
    place = pick_place(rng, lambda one: str(one.crs).startswith(WGS84_GRIDS))
    case = make_table(rng, place) | {"crs": place.crs, "angle": True, "minus": ""}
    lon, lat = degrees_of(place.crs)(*place.point[:2])
    words = choose(rng, (("N/S", "E/W"), ("LatDir", "LonDir"), ("NS", "EW"), ("Hem", "Hem2")))
    count = len(case["points"])
    case["extra"] = [["N" if lat > 0 else "S"] * count, ["E" if lon > 0 else "W"] * count]
    case["columns"] = [["P", "Pt"], ["N", "Lat"], ["A0", words[0]], ["E", "Lon"],
                       ["A1", words[1]], ["Z", "Elev"]]  # fmt: skip
    return case | {"what": f"hemispheres: {words[0]}"}


CONTRADICTORY = (
    *(foreign_height,) * 3, *(foreign_place,) * 2, exchanged_names, unit_of_another,
    order_against_header, order_against_crs, turned_angles, hemispheres,
)  # fmt: skip
LABELS = {"plain": PLAIN, "doubtful": DOUBTFUL, "contradictory": CONTRADICTORY}


def generate(rng: np.random.Generator) -> Case:
    label = choose(rng, ("plain", "plain", "plain", "doubtful", "contradictory"))
    case: Case = choose(rng, LABELS[label])(rng) | {"label": label}
    return case


# ------------------------------------------------------------------ text and truth


def text_of(case: Case) -> str:
    """Write the file."""
    separator = f"{case['separator']} " if case["pad"] else case["separator"]
    end = case["separator"] if case["ends"] else ""
    header = separator.join(name for _, name in case["columns"]) + end
    has_header = any(name for _, name in case["columns"])
    lines = [*case["above"], *([header] if has_header else [])]
    lines += [separator.join(case["units"])] if case["units"] else []
    for row, cells in enumerate(cells_of(case)):
        if has_header and case["repeat_at"] and row == case["repeat_at"]:
            lines.append(header)
        lines.append(separator.join(cells) + end)
    return case["newline"].join([*lines, *case["below"]]) + case["newline"]


def cells_of(case: Case) -> list[list[str]]:
    columns = {"P": case["number"], "D": case["code"]}
    columns |= {f"A{i}": cells for i, cells in enumerate(case["extra"])}
    points = np.array(case["points"])
    digits = (case["digits"],) * 3
    if case["angle"]:
        points = np.column_stack([*degrees_of(case["crs"])(*points.T[:2]), points[:, 2]])
        digits = (9, 9, case["digits"])
    for letter, values, count in zip("ENZ", points.T, digits, strict=True):
        columns[letter] = [f"{value:.{count}f}".replace("-", case["minus"]) for value in values]
    for letter in columns:
        if letter not in "PD" and case["decimal"] == ",":
            columns[letter] = [re.sub(r"(?<=\d)\.(?=\d)", ",", cell) for cell in columns[letter]]
    return [[columns[letter][row] for letter, _ in case["columns"]] for row in range(len(points))]


def read(case: Case) -> ts.Survey | ts.TinsmithError:
    """Return the survey, or the error that refuses it."""
    options = {"crs": case["crs"]} if case["crs"] else {}
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("error")
        path = Path(folder) / f"survey{case['suffix']}"
        text = text_of(case)
        path.write_bytes(text.encode("utf-8-sig" if case["bom"] else "utf-8"))
        try:
            return ts.read(path, format="delimited", **options)
        except ts.TinsmithError as error:
            return error


def examine(case: Case) -> str:
    found = read(case)
    if isinstance(found, ts.TinsmithError):
        assert "\n" not in str(found)
        return f"{case['label']}: refused"
    notes = " ".join(found.notes)
    if case["label"] == "doubtful" and case["told"] and re.search(case["told"], notes):
        return f"{case['label']}: told"
    what = f"{case['what']}; the notes say {found.notes}"
    assert case["truth"], f"read, and is no list of points: {what}"
    expected = np.array(case["points"])
    is_same = found.points.shape == expected.shape
    assert is_same, f"{len(found.points)} of {len(expected)} points: {what}"
    has_angles = case["angle"] or len(case["columns"]) > len(LETTERS)  # these may be taken
    assert np.allclose(found.points, expected, rtol=0, atol=2e-3 if has_angles else 1e-9), (
        f"other points: {found.points[0]} for {expected[0]}: {what}"
    )
    unit = None if found.elevation_unit is None else found.elevation_unit.metres
    assert FACTORS[case["unit"]] in (None, unit), f"elevations in {found.elevation_unit}: {what}"
    return f"{case['label']}: read"


CAMPAIGNS = (
    Campaign(
        "layouts",
        "tables of survey exports of many countries, whose points and meaning are known",
        generate,
        examine,
    ),
)
