"""Everything that is delivered is opened by a program that nobody here wrote.

The tables of :mod:`support.foreign_programs` say which: a format, a kind of product or a document
that is in none of them fails here.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from support.foreign_programs import (
    DOCUMENTS,
    ELSEWHERE,
    FORMATS,
    measure_ink,
    open_all_in_mdal,
    open_in_mdal,
    print_in_librecad,
    run_program,
)
from support.product_calls import AXIS, HILL, OTHERS, PICTURES, RESULTS

import tinsmith as ts
from tinsmith.io.registry.lookup import known_formats
from tinsmith.terrain.plans.paper.files import PLAN_SUFFIXES, REPORT_SUFFIXES, SHEET_SUFFIXES

pytestmark = pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")

TESTS = Path(__file__).parents[1]
KINDS = {
    "TIN": ts.TIN,
    "Survey": ts.Survey,
    "Features": ts.Features,
    "Raster": ts.Raster,
    "Table": ts.Table,
    "Alignment": ts.Alignment,
}
SHEETS = {
    ts.Plan: PLAN_SUFFIXES,
    ts.SectionSheets: SHEET_SUFFIXES,
    ts.ProfileSheets: SHEET_SUFFIXES,
    ts.VolumeReport: REPORT_SUFFIXES,
}
PARTS = {ts.Difference: "tin", ts.BalancedPad: "tin", ts.Coregistration: "tin"}
"""Results that have a surface."""


def make_road():
    """Return an alignment of lines and an arc."""
    places = [[700_005.0, 4_000_005.0], [700_045, 4_000_005], [700_045, 4_000_055]]
    return ts.Alignment.from_points(places, crs=HILL.crs)


LINE_OF_SURVEY = [[700_010.0, 4_000_010, 321], [700_080, 4_000_070, 322]]
AXIS_OF_SHEETS = [AXIS[0, :2].tolist(), [700_075.0, 4_000_055.0]]
DELIVERED = {
    **RESULTS,
    "lines of the survey": lambda tin: ts.Survey(
        points=tin.points, crs=tin.crs, breaklines=[ts.Breakline(LINE_OF_SURVEY)]
    ),
    "grade": OTHERS["grade"],
    "alignment": lambda tin: make_road(),
    "stake points": lambda tin: ts.stake_points(
        ts.stakeout(tin, [[700_040.0, 4_000_041.0]]), crs=tin.crs
    ),
    "contour labels": lambda tin: ts.contour_labels(ts.contours(tin, 1.0)),
    "balance table": lambda tin: RESULTS["balance"](tin).table,
}


def list_formats(kind):
    """Return every format that holds a kind."""
    return [one for one in known_formats() if one.write and one.is_built_in and kind in one.writes]


def find_kind(made):
    return next((name for name, one in KINDS.items() if isinstance(made, one)), None)


def list_suffixes(one, made):
    """Return the suffixes of a format that hold something of their own."""
    if one.name in ("adcirc", "terrain-tiles"):
        return [suffix for suffix in one.suffixes if suffix != ".mbtiles"]
    if isinstance(made, ts.Table) and one.name == "csv":
        return [".csv", ".tsv"]
    return one.suffixes[:1]


def holds(one, made):
    """Whether a format holds a product, as other tests require it where it does not."""
    if isinstance(made, ts.Features):
        refused = {"landxml": made.kind == "polygons", "csv": made.kind != "points"}
        return len(made) > 0 and not refused.get(one.name, False)
    if isinstance(made, ts.Raster):
        is_length = getattr(next(iter(made.units.values()), None), "metres", None) is not None
        many = len(made.bands) > 1
        return not (one.name == "asc" and many) and (
            one.name != "terrain-tiles" or (is_length and not many)
        )
    return True


# -------------------------------------------------------------- nothing is forgotten


@pytest.mark.every_case
def test_every_format_has_a_program_that_opens_it():
    written = {one.name for one in known_formats() if one.write and one.is_built_in}
    assert written == {*FORMATS, "quantized-mesh"}
    assert all(opener.program for opener in FORMATS.values())
    assert all((TESTS.parent / path).is_file() for path in ELSEWHERE.values())
    plain = {name for name, one in FORMATS.items() if "of the tests" in one.program}
    assert plain == {name for name, one in FORMATS.items() if one.reason}


@pytest.mark.every_case
def test_every_suffix_of_sheets_has_a_program_that_opens_it():
    assert {suffix for each in SHEETS.values() for suffix in each} <= {*DOCUMENTS}


@pytest.mark.every_case
def test_every_product_is_a_kind_that_is_opened():
    for name, make in DELIVERED.items():
        made = make(HILL)
        made = getattr(made, PARTS.get(type(made), ""), made)
        known = find_kind(made) or type(made) in SHEETS or name in ELSEWHERE
        assert known, f"{name} gives a {type(made).__name__}, which no program opens"


# --------------------------------------------------------------------- all are opened


@pytest.mark.slow
@pytest.mark.parametrize("name", DELIVERED)
def test_products_are_opened_in_every_format(tmp_path, name):
    made = DELIVERED[name](HILL)
    made = getattr(made, PARTS.get(type(made), ""), made)
    kind, meshes = find_kind(made), []
    for one in list_formats(kind) if kind else ():
        if one.name in ELSEWHERE or not holds(one, made):
            continue
        for suffix in list_suffixes(one, made):
            path = ts.write(made, tmp_path / f"of-{one.name}{suffix}", format=one.name)
            opener = FORMATS[one.name]
            if opener.open is open_in_mdal and isinstance(made, ts.TIN):
                meshes.append((path, made))
            elif opener.open is not open_in_mdal:
                opener.open(path, made)
    if meshes:
        open_all_in_mdal(meshes)
    for suffix in SHEETS.get(type(made), ()):
        for path in made.save(tmp_path / f"sheets{suffix}"):
            DOCUMENTS[suffix].open(path, made if suffix == ".pdf" else None)


@pytest.mark.slow
def test_diagrams_are_opened(tmp_path):
    volumes = RESULTS["section_volumes"](HILL)
    figures = {name: make(HILL) for name, make in PICTURES.items()}
    figures["mass haul"] = ts.mass_haul_picture(volumes)
    for name, figure in figures.items():
        for suffix in (".png", ".pdf"):
            path = tmp_path / f"{name}{suffix}"
            figure.savefig(path)
            DOCUMENTS[suffix].open(path, None)


# --------------------------------------------------------------------------- LibreCAD


@pytest.mark.slow
@pytest.mark.parametrize("crs", ["EPSG:32616", "EPSG:2277", None], ids=["m", "US ft", "none"])
def test_librecad_prints_plans_true_to_scale(tmp_path, crs):
    """At coordinates of millions, and in units that LibreCAD does not know."""
    corners = {"EPSG:32616": [700_000, 4e6], "EPSG:2277": [3_100_000, 10_100_000]}
    points = np.column_stack(
        [HILL.points[:, :2] - HILL.points[:, :2].min(axis=0), HILL.points[:, 2]]
    )
    points[:, :2] += corners.get(crs, [0, 0])
    unit = None if crs else "m"
    plan = ts.plan(ts.triangulate(points, crs=crs), paper="A4", scale=1000, ground_unit=unit)
    page = print_in_librecad(plan.save(tmp_path / "plan.dxf")[0])
    measured = read_page_size(page)
    assert measured == pytest.approx(plan.paper, abs=1.0)
    west, south, east, north = measure_frame(page)
    assert [west, south] == pytest.approx([8.0, 8.0], abs=1.0)
    assert [east, north] == pytest.approx([plan.paper[0] - 8.0, plan.paper[1] - 8.0], abs=1.0)


@pytest.mark.slow
@pytest.mark.parametrize("version", ["R2010", "R12"])
def test_librecad_prints_drawings_in_the_middle_of_the_page(tmp_path, version):
    path = ts.write(HILL, tmp_path / "tin.dxf", version=version)
    flags = ("-a", "-c") if version == "R12" else ()  # R12 has no place for the scale
    page = print_in_librecad(path, *flags)
    width, height = read_page_size(page)
    west, south, east, north = measure_frame(page)
    assert west + east == pytest.approx(width, abs=2.0)
    assert south + north == pytest.approx(height, abs=2.0)
    assert north - south > 0.8 * height


@pytest.mark.slow
def test_librecad_prints_sheets_beside_each_other(tmp_path):
    sheets = ts.section_sheets(
        HILL, AXIS_OF_SHEETS, interval=5.0, width=30.0, scale=200, paper="A4"
    )
    assert len(sheets) > 1
    page = print_in_librecad(sheets.save(tmp_path / "sheets.dxf")[0])
    width, height = read_page_size(page)
    assert height == pytest.approx(sheets.paper[1], abs=1.0)
    assert width == pytest.approx(len(sheets) * (sheets.paper[0] + 20.0) - 20.0, abs=1.0)
    assert measure_ink(page) > 0.001


def read_page_size(path):
    """Return width and height of the first page in millimetres, as poppler tells them."""
    (line,) = [one for one in run_program("pdfinfo", path).splitlines() if "Page size" in one]
    words = line.split(":")[1].split()
    return float(words[0]) * 25.4 / 72, float(words[2]) * 25.4 / 72


def measure_frame(path, dpi=100):
    """Return the bounds of all ink of a page, in millimetres from its lower left corner."""
    from PIL import Image

    measure_ink(path, dpi=dpi)
    with Image.open(path.with_name(f"{path.stem}-page.png")) as picture:
        ink = np.asarray(picture.convert("L")) < 250
    rows, columns = np.flatnonzero(ink.any(axis=1)), np.flatnonzero(ink.any(axis=0))
    mm = 25.4 / dpi
    return (columns[0] * mm, (len(ink) - 1 - rows[-1]) * mm, columns[-1] * mm,
            (len(ink) - 1 - rows[0]) * mm)  # fmt: skip
