"""Campaigns: survey text whose points are known, in any layout, and survey text that is damaged."""

from __future__ import annotations

import csv
import io
import tempfile
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts

from .campaign import Campaign, Case

# Where sites lie: CRS, middle, and whether their eastings and northings exchanged lie outside.
SITES = {
    "utm": ("EPSG:32616", (752_700.0, 4_024_240.0), True),
    "state plane": ("EPSG:2274", (2_500_000.0, 600_000.0), True),
    "swiss": ("EPSG:2056", (2_600_000.0, 1_200_000.0), True),
    "british": ("EPSG:27700", (407_000.0, 287_000.0), False),
    "equator": ("EPSG:32631", (450_000.0, 512_000.0), False),
    "local": (None, (5_000.0, 1_000.0), False),
    "small": (None, (10.0, 20.0), False),
}
LAYOUTS = ("PNEZD", "PENZD", "PNEZ", "PENZ", "NEZ", "ENZ", "NEZD", "ENZD", "ENZA", "NEZA", "PENZA")
LAYOUTS = (*LAYOUTS, "ENZPD", "ENZAAA", "DENZ", "PENZAD")
DELIMITERS = (",", ",", ",", ";", "\t", "|", " ")
HEADERS: dict[str, tuple[str, ...]] = {
    "P": ("Point", "Nr", "pt", "id"),
    "N": ("Northing", "N", "north", "Y"),
    "E": ("Easting", "E", "east", "X"),
    "Z": ("Elevation", "Z", "elev", "Elevation_ft"),
    "D": ("Description", "code", "D"),
    "A": ("intensity", "quality", "return"),
}
WORDS = (
    "GS",
    "EP",
    "TREE",
    "EP, NORTH",
    "MH, 12, OLD",
    '6" PVC',
    "24 PINE",
    "BLDG 2 CLS",
    "12",
    "",
)


def choose(rng: np.random.Generator, items: Any) -> Any:
    return items[int(rng.integers(len(items)))]


def generate(rng: np.random.Generator) -> Case:
    site = choose(rng, tuple(SITES))
    crs, (e, n), _ = SITES[site]
    count = int(rng.integers(4, 40)) if rng.random() < 0.9 else int(rng.integers(300, 700))
    digits = int(choose(rng, (3, 3, 2, 1, 0, 0)))
    layout, delimiter = choose(rng, LAYOUTS), choose(rng, DELIMITERS)
    decimal = "," if delimiter in ";\t " and rng.random() < 0.4 else "."
    size = float(choose(rng, (5.0, 60.0, 900.0)))
    columns = {
        "E": numbers(e + rng.random(count) * size, digits),
        "N": numbers(n + rng.random(count) * size, digits),
        "Z": numbers(choose(rng, (3.0, 322.0, 1_032.0)) + rng.random(count) * size / 20, digits),
        "A": [str(i) for i in rng.integers(0, 300, count)],
        "D": [choose(rng, WORDS) for _ in range(count)],
        "P": point_numbers(rng, count),
    }
    for row in range(count):
        if rng.random() < float(choose(rng, (0.0, 0.0, 0.1))):
            columns["Z"][row] = choose(rng, ("", "NaN", "-"))
    case = {
        "site": site,
        "layout": layout,
        "delimiter": delimiter,
        "separator": delimiter,
        "decimal": decimal,
        "has_crs": bool(crs is not None and rng.random() < 0.7),
        "told": bool(rng.random() < 0.15),
        "header": header(rng, layout) if rng.random() < 0.4 else [],
        "is_quoted": bool(rng.random() < 0.7),
        "groups": bool(digits and rng.random() < 0.1),  # 4.024 is no thousand to anyone
        "groups_of_whole": False,
        "suffix": choose(rng, (".csv", ".txt", ".txt", ".xyz", ".asc")),
        "rows": [[columns[letter][row] for letter in layout] for row in range(count)],
    }
    return separated_by_two(rng, case) if not digits and decimal == "." else case


def separated_by_two(rng: np.random.Generator, case: Case) -> Case:
    """Let two letters stand between whole numbers, some of which have thousands separators."""
    if case["delimiter"] == " " or rng.random() < 0.3:
        return case
    others = (" ", "\t") if case["delimiter"] == "," else (" ", ",", ",")
    pair = [case["delimiter"], choose(rng, others)]
    return case | {
        "separator": "".join(rng.permutation(pair)),
        "is_quoted": False,
        "groups_of_whole": bool(rng.random() < 0.7),
    }


def numbers(values: Any, digits: int) -> list[str]:
    return [f"{value:.{digits}f}" for value in values]


def point_numbers(rng: np.random.Generator, count: int) -> list[str]:
    kind = int(rng.integers(6))
    given = np.arange(1, count + 1) + int(choose(rng, (0, 100, 5_000)))
    if kind == 1:
        given[int(rng.integers(count))] = given[0]
    if kind == 2:
        given = rng.permutation(given)
    if kind == 3:
        given = given % max(2, count // 3)
    texts = [str(one) for one in given]
    if kind == 4:
        texts = [f"P{one}" for one in texts]
    if kind == 5:
        texts[int(rng.integers(count))] = choose(rng, ("12A", "", "STA7"))
    return texts


def header(rng: np.random.Generator, layout: str) -> list[str]:
    kind = int(rng.integers(4))
    repeats = {"A": iter(HEADERS["A"])}
    return [
        next(repeats[one]) if one == "A" else HEADERS[one][min(kind, len(HEADERS[one]) - 1)]
        for one in layout
    ]


def text_of(case: Case) -> str:
    """Write the file; a description between blanks or unquoted stands as it is."""
    delimiter = case["delimiter"]
    text = io.StringIO(newline="")
    quoting = csv.QUOTE_MINIMAL
    writer = csv.writer(text, delimiter=delimiter, lineterminator="\n", quoting=quoting)
    rows = ([case["header"]] if case["header"] else []) + [
        cells_of(row, case) for row in case["rows"]
    ]
    for row in rows:
        if case["is_quoted"] and delimiter != " ":
            writer.writerow(row)
        else:
            text.write(case["separator"].join(row) + "\n")
    return text.getvalue()


def cells_of(row: list[str], case: Case) -> list[str]:
    cells = []
    for letter, cell in zip(case["layout"], row, strict=True):
        shown = cell
        if letter in "ENZ":
            shown = grouped(cell) if has_groups(case) else cell
            if case["decimal"] == ",":
                shown = shown.replace(",", "_").replace(".", ",").replace("_", ".")
        if case["delimiter"] == " " and not cell and letter != "D":
            shown = "-"
        cells.append(shown)
    return cells


def has_groups(case: Case) -> bool:
    """Whether digits are grouped, and no group can be a column: quoted, or delimited apart."""
    is_apart = case["delimiter"] != "," or case["separator"] != ","
    return (case["groups"] and case["is_quoted"]) or (case["groups_of_whole"] and is_apart)


def grouped(cell: str) -> str:
    try:
        digits = len(cell.partition(".")[2])
        return f"{float(cell):,.{digits}f}" if cell not in ("", "NaN", "-") else cell
    except ValueError:
        return cell


def truth(case: Case) -> np.ndarray:
    """Return easting, northing and elevation of the rows that have one."""
    at = [case["layout"].index(letter) for letter in "ENZ"]
    rows = [[row[i] for i in at] for row in case["rows"]]
    kept = [row for row in rows if row[2] not in ("", "NaN", "-")]
    return np.array([[float(cell) for cell in row] for row in kept]).reshape(-1, 3)


def read(text: bytes, suffix: str, **options: Any) -> ts.Survey | ts.TinsmithError:
    """Return the survey, or the error that refuses it."""
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("error")
        path = Path(folder) / f"survey{suffix}"
        path.write_bytes(text)
        try:
            return ts.read(path, format="delimited", **options)
        except ts.TinsmithError as error:
            return error


def examine(case: Case) -> str:
    crs, _, is_certain = SITES[case["site"]]
    options: dict[str, Any] = {"crs": crs} if case["has_crs"] else {}
    if case["told"]:
        options["columns"] = case["layout"].replace("A", "-")
    expected = truth(case)
    found = read(text_of(case).encode(), case["suffix"], **options)
    if isinstance(found, ts.TinsmithError):
        assert not must_read(case, is_certain), f"refused: {found}"
        assert "\n" not in str(found)
        return "refused"
    if np.array_equal(found.points, expected):
        return "read"
    if has_groups(case) and any("usual between semicolons" in note for note in found.notes):
        return "read by custom"
    is_custom = any("the convention for" in note for note in found.notes)
    assert is_custom, f"other points, and the notes say {found.notes}"
    assert case["layout"].startswith("NEZ")
    assert np.array_equal(found.points[:, [1, 0, 2]], expected), "other points by custom"
    return "read by custom"


def must_read(case: Case, is_certain: bool) -> bool:
    """Whether nothing in the file is doubtful: a header or the area tells, and cells are plain."""
    told = case["told"] or case["header"]
    places = case["has_crs"] and is_certain and case["layout"][0] != "D"
    has_odd_text = "D" in case["layout"] and not (case["is_quoted"] and case["delimiter"] != " ")
    is_plain = not has_odd_text and not has_groups(case) and len(truth(case)) > 3
    is_plain &= case["is_quoted"] or case["separator"].strip(" ") == case["delimiter"]
    is_blank = case["delimiter"] == " "
    digits = {len(row[case["layout"].index("E")].partition(".")[2]) for row in case["rows"]}
    is_blank |= case["decimal"] == "," and case["delimiter"] != ";" and digits == {3}
    is_divided = all("." in row[case["layout"].index("E")] for row in case["rows"])
    return bool((told or places) and is_plain and is_divided and not is_blank)


# ------------------------------------------------------------------ damaged files

PIECES = (
    b",",
    b";",
    b'"',
    b"\n",
    b"\r",
    b"\t",
    b" ",
    b"\x00",
    b"\xff",
    b"\xfe",
    b"#",
    b"-",
    b"9" * 400,
)
PIECES = (
    *PIECES,
    b"nan",
    b"1e999",
    b"0x",
    b"x,y,z\n",
    b"1,234,567",
    b"''",
    b"((((",
    b"\xef\xbb\xbf",
)


def generate_damaged(rng: np.random.Generator) -> Case:
    data = bytearray(text_of(generate(rng)).encode()[: int(rng.integers(1, 3_000))])
    for _ in range(int(rng.integers(1, 12))):
        damage(rng, data)
    options: dict[str, Any] = {}
    if rng.random() < 0.4:
        options["crs"] = choose(rng, ("EPSG:32616", "EPSG:2274", "EPSG:4326", "EPSG:3857"))
    if rng.random() < 0.2:
        options["columns"] = choose(rng, ("PNEZD", "XYZ", "ENZ", "x,y,z", "lon,lat,z"))
    if rng.random() < 0.4:
        options["skip_bad"] = True
    if rng.random() < 0.1:
        options["decimal"] = choose(rng, ".,")
    return {
        "text": data.decode("latin-1"),
        "suffix": choose(rng, (".csv", ".txt", ".xyz")),
        "options": options,
    }


def damage(rng: np.random.Generator, data: bytearray) -> None:
    at = int(rng.integers(len(data) + 1))
    end = min(len(data), at + int(rng.integers(1, 60)))
    kind = int(rng.integers(5))
    if kind == 0 and at < len(data):
        data[at] ^= 1 << int(rng.integers(8))
    elif kind == 1:
        data[at:end] = b""
    elif kind == 2:
        data[at:at] = data[at:end] * int(rng.integers(1, 4))
    elif kind == 3:
        data[at:at] = choose(rng, PIECES) * int(choose(rng, (1, 1, 1, 50)))
    elif kind == 4 and at < len(data):
        data[at] = int(rng.integers(256))


def examine_damaged(case: Case) -> str:
    found = read(case["text"].encode("latin-1"), case["suffix"], **case["options"])
    if isinstance(found, ts.TinsmithError):
        assert "\n" not in str(found), "a sentence of several lines"
        assert len(str(found)) < 3_000, "a sentence without end"
        return f"refused: {type(found).__name__}"
    assert np.isfinite(found.points).all()
    assert all(len(values) == len(found.points) for values in found.attributes.values())
    lost = sum(len(lines) for lines in found.skipped_lines.values())
    assert lost == sum(found.skipped.get(what, 0) for what in found.skipped_lines)
    return "read"


CAMPAIGNS = (
    Campaign("survey text", "survey text in any layout, whose points are known", generate, examine),
    Campaign(
        "damaged survey text",
        "survey text with bytes flipped, cut, joined and thrown in",
        generate_damaged,
        examine_damaged,
        seconds=10.0,
    ),
)
