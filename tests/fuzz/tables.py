"""Tables of points in random dialects, whose writer knows what is in them.

A table has a header that names its columns, in one of several languages, and rows of numbers and
texts. A dialect writes it: separator, quotes, decimal mark, thousands, units, comments, blank and
repeated lines, ragged rows, a last line of text, line ends, encoding. What is read must be what was
written, to the last bit and in order, or be refused, or be told. Tables of which nothing is
doubtful must be read.
"""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np

import tinsmith as ts

from . import delimited
from .campaign import Campaign, Case

ROLES = ("number", "easting", "northing", "elevation", "description", "quality")
NAMES = {
    "number": ("Point", "Nr", "PtID", "Punktnummer", "id", "Point Number"),
    "easting": ("Easting", "E", "X", "Rechtswert", "Este", "x_coord"),
    "northing": ("Northing", "N", "Y", "Hochwert", "Norte", "y_coord"),
    "elevation": ("Elevation", "Z", "Z", "Höhe", "Cota", "z_coord"),
    "description": ("Description", "Code", "Desc", "Bemerkung", "Código", "Feature Code"),
    "quality": ("quality", "HDOP", "Sats", "Satelliten", "precisión", "acc"),
}
UNITS = {"m": "metre", "ft": "foot", "USft": "US survey foot", "us-ft": "US survey foot"}
UNIT_FORMS = ("{} ({})", "{} [{}]", "{}_{}", "{}({})", "{} / {}")
SEPARATORS = (",", ",", ";", "\t", "|", " ", "  ")
GROUPS = {".": (",", "'", " ", "\u00a0", "\u2019"), ",": (".", "'", " ", "\u00a0", "\u2019")}
WORDS = ("GS", "EP", "TREE 24", "Mauer", "Straße", "bord dr.", "", "N/A", "12", "été", "a'b", '6"')
COMMENTS = ("#", "//", ";", "%", "!")
ENDS = ("\n", "\n", "\r\n", "\r")
ENCODINGS = ("utf-8", "utf-8", "utf-8-sig", "utf-16", "cp1252")
FOOTERS = ("END", "Total: {n} points", "{n} Punkte", "-- end of file --", "Mean;{z}", "\x1a")
NONE = ("", "", "NaN", "-", "n/a", "null")
SUFFIXES = (".csv", ".txt", ".asc", ".dat", ".tsv", ".xyz", ".pts")


def choose(rng: np.random.Generator, items: Any) -> Any:
    return items[int(rng.integers(len(items)))]


def generate(rng: np.random.Generator) -> Case:
    count = int(rng.integers(4, 30)) if rng.random() < 0.9 else int(rng.integers(200, 400))
    digits = int(choose(rng, (3, 3, 2, 1, 4)))
    middle = choose(rng, ((752_700.0, 4_024_240.0), (500.0, 1_000.0), (2_600_000.0, 1_200_000.0)))
    roles = ["easting", "northing", "elevation"]
    roles = [roles[i] for i in (rng.permutation(3) if rng.random() < 0.5 else range(3))]
    roles = (["number"] if rng.random() < 0.6 else []) + roles
    roles += [one for one in ("description", "quality") if rng.random() < 0.4]
    values = {
        "number": [str(i) for i in range(1, count + 1)],
        "easting": numbers(middle[0] + rng.random(count) * 90, digits),
        "northing": numbers(middle[1] + rng.random(count) * 90, digits),
        "elevation": numbers(choose(rng, (3.0, 322.0, 1_032.0)) + rng.random(count) * 9, digits),
        "description": [str(choose(rng, WORDS)) for _ in range(count)],
        "quality": numbers(rng.random(count), 2),
    }
    if rng.random() < 0.25:
        values["elevation"][int(rng.integers(count))] = choose(rng, NONE)
    return {
        "roles": roles,
        "rows": [[values[role][row] for role in roles] for row in range(count)],
        "dialect": make_dialect(rng, count),
        "suffix": choose(rng, SUFFIXES),
        "told": [one for one in ("columns", "decimal", "delimiter") if rng.random() < 0.15],
        "skip_bad": bool(rng.random() < 0.2),
    }


def make_dialect(rng: np.random.Generator, count: int) -> dict[str, Any]:
    """Draw how the table is written; most oddities are rare, so that many files have one alone."""

    def at_times(value: Any, share: float = 0.12, other: Any = None) -> Any:
        return value if rng.random() < share else other

    decimal = at_times(",", 0.3, ".")
    place = int(rng.integers(count))
    return {
        "separator": choose(rng, SEPARATORS),
        "decimal": decimal,
        "group": at_times(choose(rng, GROUPS[decimal]), other=""),
        "grouped": choose(rng, ("all", "plane", "some")),
        "quotes": choose(rng, ("none", "needed", "needed", "texts", "all")),
        "names": int(rng.integers(len(NAMES["number"]))),
        "case": choose(rng, ("", "", "upper", "lower")),
        "unit": at_times(choose(rng, tuple(UNITS)), 0.25),
        "unit form": choose(rng, UNIT_FORMS),
        "units of": choose(rng, ("elevation", "elevation", "all")),
        "unit place": choose(rng, ("header", "header", "line", "cells")),
        "title": at_times(choose(rng, ("Site 12", "Job: A 7, 2024", "Export;1.5"))),
        "comment": at_times(choose(rng, COMMENTS), 0.2),
        "comment at": [0, place] if rng.random() < 0.5 else [0],
        "blank at": at_times([place]) or [],
        "header at": at_times([place], 0.08) or [],
        "short at": at_times([place], 0.08) or [],
        "long at": at_times([place], 0.08) or [],
        "trailing": bool(rng.random() < 0.08),
        "padding": bool(rng.random() < 0.1),
        "plus": bool(rng.random() < 0.06),
        "exponent": bool(rng.random() < 0.06),
        "footer": at_times(choose(rng, FOOTERS), 0.1),
        "has end": bool(rng.random() < 0.8),
        "end": choose(rng, ENDS),
        "encoding": choose(rng, ENCODINGS),
        "has header": bool(rng.random() < 0.9),
    }


def numbers(values: Any, digits: int) -> list[str]:
    return [f"{value:.{digits}f}" for value in values]


# ----------------------------------------------------------------------- the writer


def text_of(case: Case) -> str:
    """Write the table line by line."""
    how, lines = case["dialect"], []
    header = join_cells(list_names(case), case, is_header=True)
    if how["title"]:
        lines.append(how["title"])
    if how["has header"]:
        lines.append(header)
    if how["has header"] and how["unit"] and how["unit place"] == "line":
        lines.append(join_cells(list_units(case), case, is_header=True))
    for number, row in enumerate(case["rows"]):
        if how["comment"] and number in how["comment at"]:
            lines.append(f"{how['comment']} set up on 7, 1.5 high")
        if number in how["blank at"]:
            lines.append("")
        if number in how["header at"] and how["has header"] and number:
            lines.append(header)
        lines.append(join_cells(change_length(row, number, case), case, is_header=False))
    if how["footer"]:
        lines.append(how["footer"].format(n=len(case["rows"]), z=case["rows"][0][-1]))
    return how["end"].join(lines) + (how["end"] if how["has end"] else "")


def list_names(case: Case) -> list[str]:
    how = case["dialect"]
    names = []
    for role in case["roles"]:
        name = NAMES[role][how["names"]]
        name = getattr(name, how["case"])() if how["case"] else name
        if how["separator"][0] == " ":
            name = name.replace(" ", "_")
        if how["unit"] and how["unit place"] == "header" and has_unit(role, how):
            name = how["unit form"].format(name, how["unit"])
        names.append(name)
    return names


def list_units(case: Case) -> list[str]:
    how = case["dialect"]
    return [how["unit"] if has_unit(role, how) else "" for role in case["roles"]]


def has_unit(role: str, how: dict[str, Any]) -> bool:
    return role == "elevation" or (how["units of"] == "all" and role in ROLES[1:3])


def change_length(row: list[str], number: int, case: Case) -> list[str]:
    how = case["dialect"]
    if number in how["short at"]:
        return row[:-1]
    return [*row, "7.5"] if number in how["long at"] else row


def join_cells(cells: list[str], case: Case, *, is_header: bool) -> str:
    """Join cells, those quoted that must be and those that the dialect quotes."""
    how = case["dialect"]
    separator, written = how["separator"], []
    if separator.isspace() and separator != "\t" and how["quotes"] == "none":
        cells = [cell or "-" for cell in cells]  # an empty cell is none between blanks
    for place, cell in enumerate(cells):
        role = case["roles"][place] if place < len(case["roles"]) else "quality"
        shown = cell if is_header else write_cell(cell, role, how)
        is_text = is_header or role == "description"
        must = separator[0] in shown or '"' in shown or (not shown and separator[0] == " ")
        quoted = {"none": False, "needed": must, "texts": is_text or must, "all": True}
        if quoted[how["quotes"]]:
            shown = '"' + shown.replace('"', '""') + '"'
        written.append(f" {shown} " if how["padding"] else shown)
    return separator.join(written) + (separator if how["trailing"] else "")


def write_cell(cell: str, role: str, how: dict[str, Any]) -> str:
    if role in ("number", "description") or not is_number(cell):
        return cell
    shown = cell
    if how["exponent"]:
        shown = f"{float(cell):.12E}"
    elif how["group"] and (how["grouped"] == "all" or role in ROLES[1:3]):
        whole, point, rest = cell.partition(".")
        shown = f"{int(whole):,}".replace(",", "\0") + point + rest
    shown = shown.replace(".", how["decimal"]).replace("\0", how["group"])
    if how["plus"] and not shown.startswith("-"):
        shown = f"+{shown}"
    if how["unit"] and how["unit place"] == "cells" and has_unit(role, how):
        shown = f"{shown} {how['unit']}"
    return shown


def is_number(cell: str) -> bool:
    return re.fullmatch(r"-?\d+\.?\d*", cell) is not None


# ----------------------------------------------------------------------- the oracle


def truth(case: Case) -> tuple[np.ndarray, list[int]]:
    """Return the points that have an elevation, and the rows that they are."""
    at = [case["roles"].index(role) for role in ROLES[1:4]]
    kept = [i for i, row in enumerate(case["rows"]) if is_number(row[at[2]])]
    found = [[float(case["rows"][i][k]) for k in at] for i in kept]
    return np.array(found).reshape(-1, 3), kept


def examine(case: Case) -> str:
    how = case["dialect"]
    try:
        data = text_of(case).encode(how["encoding"])
    except UnicodeEncodeError:
        return "cannot be encoded"
    found = read(data, case)
    if isinstance(found, ts.TinsmithError):
        assert "\n" not in str(found), "a sentence of several lines"
        assert not is_clear(case), f"refused: {found}"
        return f"refused: {type(found).__name__}"
    expected, kept = truth(case)
    kept = leave_out_told(found, case, kept)
    expected, rows = truth({**case, "rows": [case["rows"][i] for i in kept]})
    assert found.points.shape == expected.shape, explain(found, expected)
    if not np.array_equal(found.points, expected):
        require_told(found, expected, case)
        return "told"
    require_unit(found, how)
    require_attributes(found, case, [kept[i] for i in rows])
    return "read"


def read(data: bytes, case: Case) -> ts.Survey | ts.TinsmithError:
    options: dict[str, Any] = {"skip_bad": True} if case["skip_bad"] else {}
    how = case["dialect"]
    if "columns" in case["told"]:
        letters = dict(zip(ROLES, "PENZD-", strict=True))
        options["columns"] = "".join(letters[role] for role in case["roles"])
    if "decimal" in case["told"]:
        options["decimal"] = how["decimal"]
    if "delimiter" in case["told"]:
        options["delimiter"] = how["separator"][0]
    return delimited.read(data, case["suffix"], **options)


def leave_out_told(found: ts.Survey, case: Case, kept: list[int]) -> list[int]:
    """Take the rows away that the survey says are left out, by the numbers of their lines."""
    lines = text_of(case).split(case["dialect"]["end"])
    told = {line for what in found.skipped_lines.values() for line in what}
    content = {lines[line - 1] for line in told if line <= len(lines)}
    own = [
        join_cells(change_length(row, i, case), case, is_header=False)
        for i, row in enumerate(case["rows"])
    ]
    return [i for i in kept if own[i] not in content]


def explain(found: ts.Survey, expected: np.ndarray) -> str:
    return (
        f"{found.points[:2].tolist()} of {len(found.points)} points, not "
        f"{expected[:2].tolist()} of {len(expected)}; skipped {found.skipped_lines}, notes "
        f"{found.notes}"
    )


def require_told(found: ts.Survey, expected: np.ndarray, case: Case) -> None:
    """Other numbers are to be told: axes by custom without a header, marks between semicolons."""
    notes = " ".join(found.notes)
    how = case["dialect"]
    is_exchanged = np.array_equal(np.sort(found.points, axis=1), np.sort(expected, axis=1))
    if not how["has header"] and "columns" not in case["told"] and is_exchanged:
        assert "No header" in notes, explain(found, expected)
        return
    told = ("usual between", "check the columns")
    assert any(one in notes for one in told), explain(found, expected)


def require_unit(found: ts.Survey, how: dict[str, Any]) -> None:
    """A unit of elevations that the file tells is that of the survey; or a note doubts it."""
    told = how["unit"] if how["unit"] else None
    is_in_header = how["has header"] and how["unit place"] in ("header", "line")
    if told is None or (not is_in_header and how["unit place"] != "cells"):
        assert found.elevation_unit is None, f"{found.elevation_unit} out of nothing"
        return
    unit = found.elevation_unit
    if unit is not None:
        assert unit.name == UNITS[told], f"{unit.name}, not {told}"
        return
    is_told = any(told in note for note in found.notes)
    is_named_column = "_" in how["unit form"] or "/" in how["unit form"]
    assert is_told or is_named_column, f"the unit {told} is lost: {found.notes}"


def require_attributes(found: ts.Survey, case: Case, rows: list[int]) -> None:
    """Numbers and texts stand beside their own points, where a header or the caller names them."""
    how = case["dialect"]
    if any("No header" in note for note in found.notes):
        return
    if how["unit"] and how["unit place"] == "cells" and how["separator"][0] == " ":
        return  # the unit is part of the next column, which a note tells
    for role in ("number", "description"):
        if role not in case["roles"] or role not in found.attributes:
            continue
        place = case["roles"].index(role)
        own = [case["rows"][row][place] for row in rows]
        here = ["" if is_nan(one) else str(one).strip() for one in found.attributes[role].tolist()]
        here = [re.sub(r"\.0$", "", one) for one in here]
        short = set(case["dialect"]["short at"]) | set(case["dialect"]["long at"])
        wrong = [
            (a, b)
            for a, b, row in zip(own, here, rows, strict=True)
            if a.strip() != b and (a, b) != ("", "-") and row not in short
        ]
        assert not wrong, f"{role}: {wrong[:3]}"


def is_nan(value: Any) -> bool:
    return isinstance(value, float) and math.isnan(value)


def is_clear(case: Case) -> bool:
    """Whether nothing in the file is doubtful: then it must be read."""
    how, separator = case["dialect"], case["dialect"]["separator"]
    if separator.isspace() and separator != "\t":
        return False
    odd = ("group", "title", "comment", "footer", "blank at", "header at", "short at", "long at")
    odd = (*odd, "trailing", "unit")
    if not how["has header"] or any(how[name] for name in odd):
        return False
    if how["decimal"] == "," and separator == "," and how["quotes"] == "none":
        return False
    if separator == "\t" and how["padding"]:
        return False
    if how["quotes"] == "none" and "description" in case["roles"]:
        return False
    if how["decimal"] == ",":  # three digits may be a thousand
        return False
    return how["encoding"] in ("utf-8", "utf-8-sig") and how["names"] in (0, 1) and not how["case"]


CAMPAIGNS = (
    Campaign(
        "tables", "tables in any dialect, whose writer knows what is in them", generate, examine
    ),
)
