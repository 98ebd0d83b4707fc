"""Which cells of a raster are read, where they lie, and what is refused before any is read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tinsmith import OptionError, ReadError
from tinsmith.base.crs import CRS, FOOT, METRE, US_SURVEY_FOOT
from tinsmith.io.isolated import Limits, limits
from tinsmith.io.raster import reading
from tinsmith.tin import Bounds

PATH = Path("ground.tif")


def header(**given):
    """What a raster of 7 columns and 5 rows says of itself, cells of 2 by 3 units."""
    usual = {
        "path": PATH, "count": 2, "subdatasets": [], "colours": ["gray", "undefined"],
        "dtypes": ["float32", "float32"], "width": 7, "height": 5,
        "transform": reading.Affine(2.0, 0.0, 100.0, 0.0, -3.0, 500.0), "block_height": 1,
        "block_width": 7, "scales": [1.0, 1.0], "offsets": [0.0, 0.0],
        "nodata": [None, None], "units": [None, None],
        "crs": None, "limits": Limits(5.0, 1 << 30),
    }  # fmt: skip
    return reading.Header(**{**usual, "meanings": [], "tags": {}, **given})


def choose_cells(stride=1, **part):
    part = {"window": None, "cells": None, **part}
    choice = reading.Choice(band=None, **part, stride=stride, nodata=None, fill=False)
    return reading._choose_cells(header(), choice)


def sentence_of(kind, function, *arguments):
    with pytest.raises(kind) as caught:
        function(*arguments)
    return str(caught.value)


# ---------------------------------------------------------------- transform


@pytest.mark.parametrize("seed", range(5))
def test_the_inverse_leads_back(seed):
    rng = np.random.default_rng(seed)
    affine = reading.Affine(*rng.uniform(-9, 9, 6))
    column, row = rng.uniform(0, 100, (2, 20))
    there = affine.apply(column, row)
    np.testing.assert_allclose(
        there, np.array([affine[0:3], affine[3:6]]) @ [column, row, np.ones(20)]
    )
    np.testing.assert_allclose(affine.invert().apply(*there), [column, row], atol=1e-9)


@pytest.mark.parametrize(
    ("affine", "bounds"),
    [
        ((2, 0, 100, 0, -3, 500), (100, 485, 114, 500)),
        ((2, 0, 100, 0, 3, 500), (100, 500, 114, 515)),
        ((-2, 0, 100, 0, -3, 500), (86, 485, 100, 500)),
        ((2, 1, 0, 1, -3, 0), (0, -15, 19, 7)),
    ],
)
def test_the_bounds_hold_all_cells(affine, bounds):
    assert header(transform=reading.Affine(*map(float, affine))).bounds == bounds


def test_centres_lie_half_a_cell_in_and_the_middle_in_the_middle():
    raster = header()
    x, y = reading._compute_centres(raster, np.array([0, 6]), np.array([0, 2, 4]))
    assert x.tolist() == [[101, 113]] * 3
    assert y.T.tolist() == [[498.5, 492.5, 486.5]] * 2
    assert reading.find_middle(raster).tolist() == [[107.0, 492.5, 0.0]]


# -------------------------------------------------------------------- cells


@pytest.mark.parametrize("stride", range(1, 6))
@pytest.mark.parametrize(("row", "height"), [(0, 20), (3, 11), (5, 7)])
@pytest.mark.parametrize("block", [1, 2, 3, 50])
def test_strips_hold_every_row_wanted_once(monkeypatch, stride, row, height, block):
    monkeypatch.setattr(reading, "_STRIP_CELLS", 12)
    cells = reading.Cells(2, row, 4, height, stride)
    raster = header(height=40, block_height=block)
    strips = reading._cut_into_strips(raster, cells)
    wanted = list(range(row, row + height, stride))
    assert [one for strip in strips for one in strip.tolist()] == wanted
    assert cells.columns.tolist() == list(range(2, 6, stride))
    assert all(map(len, strips))


@pytest.mark.parametrize(
    ("block", "width", "height"),
    [(1, 4, 3), (1, 5, 2), (1, 12, 1), (1, 13, 1), (2, 3, 4), (2, 4, 2), (5, 4, 5), (0, 4, 3)],
)
def test_strips_are_whole_blocks_of_some_cells(monkeypatch, block, width, height):
    monkeypatch.setattr(reading, "_STRIP_CELLS", 12)
    cells = reading.Cells(0, 0, width, 9, 1)
    assert reading._choose_strip_height(header(block_height=block), cells) == height


@pytest.mark.parametrize(
    ("bounds", "part"),
    [
        ((100, 485, 114, 500), (0, 0, 7, 5)),
        ((0, 0, 999, 999), (0, 0, 7, 5)),
        ((102, 488, 104, 494), (1, 2, 1, 2)),
        ((101.9, 487.9, 104.1, 494.1), (0, 1, 3, 4)),
        ((113.9, 485, 300, 485.1), (6, 4, 1, 1)),
    ],
)
def test_bounds_choose_the_cells_that_they_touch(bounds, part):
    cells = choose_cells(window=Bounds(*map(float, bounds)))
    assert choose_cells(window=bounds) == cells
    assert (cells.column, cells.row, cells.width, cells.height) == part
    assert cells.bounds == Bounds(*bounds)


NAMING = "; a part in cells (column, row, width, height) is the option `cells`."


def refuse(**part):
    with pytest.raises(OptionError) as caught:
        choose_cells(**part)
    return str(caught.value)


@pytest.mark.parametrize(
    "bounds",
    [(114, 485, 120, 500), (0, 485, 100, 500), (100, 500, 114, 501), (100, 0, 114, 485)],
)
def test_bounds_beyond_the_raster_are_refused(bounds):
    said = refuse(window=Bounds(*map(float, bounds)))
    assert said == (
        f"Invalid window {list(map(float, bounds))}: it must be an area that meets the file, "
        f"which spans easting 100 to 114 and northing 485 to 500{NAMING}"
    )


@pytest.mark.parametrize("bounds", [(110, 485, 105, 500), (100, 495, 114, 490), (4, 2, 3, 3)])
def test_turned_bounds_are_refused(bounds):
    said = refuse(window=bounds)
    assert said == (
        f"Invalid window {list(bounds)}: it must be Bounds, or four finite numbers: west, south, "
        f"east and north limit, the lower ones first{NAMING}"
    )


@pytest.mark.parametrize("window", [(0, 0, 7), (0, 0, 7, 5, 1), (0, 0, np.nan, 5), 7, "abcd"])
def test_a_window_is_four_numbers(window):
    assert "four finite numbers: west, south, east and north limit" in refuse(window=window)


@pytest.mark.parametrize("cells", [(0, 0, 7, 5), (6, 4, 1, 1), [1, 1, 2, 3]])
def test_cells_are_taken_as_they_are(cells):
    found = choose_cells(cells=cells)
    assert (found.column, found.row, found.width, found.height) == tuple(cells)
    assert found.bounds is None


@pytest.mark.parametrize("cells", [(0, 0, 7, 5), (6, 4, 1, 1), (1, 1, 2, 3)])
def test_cells_given_as_a_window_are_refused_with_the_option_to_use(cells):
    assert refuse(window=cells).endswith(NAMING)


def test_a_window_that_may_be_meant_as_cells_is_told():
    raster = header(transform=reading.Affine(1.0, 0.0, 0.0, 0.0, -1.0, 5.0))
    choice = {"band": None, "cells": None, "stride": None, "nodata": None, "fill": False}
    for window, is_stated in [((1, 1, 3, 4), True), ((1, 1, 3.0, 4), False), ((1, 1, 7, 5), False),
                            (Bounds(1, 1, 3, 4), False), (None, False)]:  # fmt: skip
        notes = reading._describe_window(raster, reading.Choice(window=window, **choice))
        assert bool(notes) == is_stated
    notes = reading._describe_window(raster, reading.Choice(window=(1, 1, 3, 4), **choice))
    assert notes == [
        "The window 1, 1, 3, 4 is in coordinates (west, south, east, north); cells by column, row, "
        "width and height are the option `cells`."
    ]


def test_a_part_is_a_window_or_cells():
    said = refuse(window=Bounds(100, 485, 114, 500), cells=(0, 0, 2, 2))
    assert said == "Invalid cells [0, 0, 2, 2]: it must be None where a window is given."


@pytest.mark.parametrize(
    "cells",
    [(0, 0, 8, 5), (0, 0, 7, 6), (-1, 0, 3, 3), (0, -1, 3, 3), (0, 0, 0, 5), (0, 0, 7, 0),
     (6, 0, 2, 1), (0, 4, 1, 2)],
)  # fmt: skip
def test_cells_must_lie_in_the_raster(cells):
    assert refuse(cells=cells) == (
        f"Invalid cells {list(cells)}: it must be a part of the file: the raster has 7 "
        "columns and 5 rows."
    )


@pytest.mark.parametrize(
    "cells", [(0, 0, 7), (0, 0, 7, 5, 1), (0.0, 0, 7, 5), 7, "abcd", (0, 0, 7, True)]
)
def test_cells_are_four_whole_numbers(cells):
    shown = list(cells) if isinstance(cells, tuple) else cells
    assert refuse(cells=cells) == (
        f"Invalid cells {shown!r}: it must be four whole numbers (first column, first row, width, "
        "height); the raster has 7 columns and 5 rows."
    )


@pytest.mark.parametrize(
    ("cells", "stride", "most"),
    [(None, 5, 4), (None, 0, 4), (None, 1.5, 4), ((0, 0, 3, 5), 3, 2), ((0, 0, 1, 1), 2, 1)],
)
def test_a_stride_leaves_two_rows_and_columns_at_least(cells, stride, most):
    said = refuse(cells=cells, stride=stride)
    assert f"Invalid stride {stride!r}: it must be a whole number from 1 to {most} for the" in said
    assert choose_cells(most, cells=cells).stride == most


# --------------------------------------------------------------------- room


@pytest.mark.parametrize(("width", "height", "stride"), [(10, 10, 1), (21, 19, 2), (30, 28, 3)])
def test_no_more_cells_are_read_than_memory_holds(monkeypatch, width, height, stride):
    cells = reading.Cells(0, 0, width, height, stride)
    count = -(-width // stride) * -(-height // stride)
    monkeypatch.setattr(reading, "measure_free_memory", lambda: 48 * count)
    reading._require_few_cells(cells)
    monkeypatch.setattr(reading, "measure_free_memory", lambda: 48 * count - 1)
    said = sentence_of(ReadError, reading._require_few_cells, cells)
    assert said == (
        f"the file: {count:,} cells are to be read, and {count - 1:,} are the most that 0.0 "
        "GiB of memory can hold: read a part of it (window) or every n-th row and column (stride)."
    )


def test_no_more_cells_are_read_than_a_tin_holds(monkeypatch):
    monkeypatch.setattr(reading, "measure_free_memory", lambda: 1 << 60)
    reading._require_few_cells(reading.Cells(0, 0, 2**31 - 1, 1, 1))
    said = sentence_of(ReadError, reading._require_few_cells, reading.Cells(0, 0, 2**31, 1, 1))
    assert "2,147,483,648 cells are to be read, and 2,147,483,647 are the most that a TIN" in said


def test_free_memory_is_what_the_system_tells(monkeypatch, tmp_path):
    files = {
        "Free: 1 kB\nMemAvailable:  2048 kB\nMemAvailable: 5 kB\n": 2048 * 1024,
        "Free: 1 kB\n": 48 * (2**31 - 1),
        "MemAvailable:\n": 48 * (2**31 - 1),
        "MemAvailable: much\n": 48 * (2**31 - 1),
    }
    for text, expected in files.items():
        (tmp_path / "meminfo").write_text(text)
        monkeypatch.setattr(limits, "Path", lambda _: tmp_path / "meminfo")
        assert limits.measure_free_memory() == expected
    monkeypatch.setattr(limits, "Path", lambda _: tmp_path / "nowhere")
    assert limits.measure_free_memory() == 48 * (2**31 - 1)


# ------------------------------------------------------------------- points


def test_a_strip_is_scaled_after_its_mask_and_before_nodata_of_the_caller():
    raster = header(scales=[1.0, 0.5], offsets=[0.0, 10.0])
    cells = reading.Cells(0, 0, 3, 2, 1, Bounds(100.0, 494.0, 104.0, 500.0))
    values = np.array([[1, 2, 3], [4, 5, 6]], np.int16)
    valid = np.array([[255, 0, 255], [1, 255, 255]], np.uint8)
    arrays = {"values": values, "valid": valid}
    plan = reading.Plan(raster, 2, cells, None, None, None, np.array([12.0]), [])
    points, numbers, keep, missing = reading._read_strip(plan, cells, np.array([0, 1]), arrays)
    assert numbers.tolist() == [0, raster.width + 1]
    assert points.tolist() == [[101, 498.5, 10.5], [103, 495.5, 12.5]]
    assert keep.tolist() == [[True, False, False], [False, True, False]]
    assert missing == 2  # one by the mask, one by the caller's word; the last column is outside
    plan = plan._replace(band=1, marks=np.array([]))
    plain = reading._read_strip(plan, cells, np.array([0, 1]), arrays).points
    assert plain[:, 2].tolist() == [1, 4, 5]


def test_elevations_that_scale_makes_infinite_are_counted():
    points = np.array([[1, 2, 3], [4, 5, np.inf], [6, 7, np.nan]])
    said = sentence_of(ReadError, reading._require_finite_centres, points, 3)
    assert said == (
        "the file: 2 cells of band 3 would have an elevation that is not finite (first at 4, "
        "5): its scale or offset is wrong."
    )
    said = sentence_of(ReadError, reading._require_finite_centres, points[:2], 1)
    assert "1 cell of band 1" in said
    reading._require_finite_centres(points[:1], 1)


# ----------------------------------------------------------------- the band

BANDS = "Invalid band {}: it must be one of the bands 1 to 2 of the file."


@pytest.mark.parametrize(
    ("given", "band", "kind", "sentence"),
    [
        ({"count": 0}, None, ReadError, "the file holds no band of its own."),
        (
            {"count": 0, "subdatasets": [*"abcdef"]},
            None,
            ReadError,
            "the file holds no band of its own but several rasters (a, b, c, d, e): extract "
            "one of them first.",
        ),
        ({}, 3, OptionError, BANDS.format("3")),
        ({}, 0, OptionError, BANDS.format("0")),
        ({}, 1.0, OptionError, BANDS.format("1.0")),
        (
            {"count": 1},
            2,
            OptionError,
            "Invalid band 2: it must be 1, the only band of the file.",
        ),
    ],
)
def test_a_band_that_is_not_there_is_refused(given, band, kind, sentence):
    assert sentence_of(kind, reading.choose_band, header(**given), band) == sentence


def test_the_first_band_is_the_default():
    assert [reading.choose_band(header(), band) for band in (None, 1, 2)] == [1, 1, 2]


@pytest.mark.parametrize(
    ("given", "band", "is_stated", "words"),
    [
        ({"colours": ["red", "gray"]}, 1, False, "is a picture (band 1 is its red), not a raster"),
        ({"colours": ["gray", "alpha"]}, 1, False, None),
        ({"colours": ["red", "gray"]}, 1, True, None),
        ({"colours": ["red", "gray"]}, 2, False, None),
        ({"dtypes": ["complex64", "f4"]}, 1, False, "band 1 holds complex numbers, no elevations."),
        ({"dtypes": ["complex64", "f4"]}, 2, False, None),
        ({"transform": reading.Affine(1, 0, 0, 0, 1, 0)}, 1, False, "has no georeference"),
        ({"transform": reading.Affine(2, 4, 0, 1, 2, 0)}, 1, False, "in which a cell has no size"),
        ({"transform": reading.Affine(2, 0, np.inf, 0, 1, 0)}, 1, False, "or none that is finite."),
        ({"transform": reading.Affine(1e200, 0, 0, 0, 1e200, 0)}, 1, False, "none that is finite."),
        ({"transform": reading.Affine(0, 2, 0, 3, 0, 0)}, 1, False, None),
    ],
)
def test_what_has_no_elevations_or_no_place_is_refused(given, band, is_stated, words):
    raster = header(**given)
    if words is None:
        reading.require_elevation_band(raster, band, is_stated)
    else:
        said = sentence_of(ReadError, reading.require_elevation_band, raster, band, is_stated)
        assert words in said


# -------------------------------------------------------------------- units

FEET_UP = CRS.of("EPSG:32616+6360")


@pytest.mark.parametrize(
    ("word", "crs", "declared", "unit", "n_notes"),
    [
        (None, None, None, None, 0),
        ("m", None, None, METRE, 0),
        (" ft ", None, None, FOOT, 0),
        (None, FEET_UP, None, US_SURVEY_FOOT, 0),
        ("US survey foot", FEET_UP, None, US_SURVEY_FOOT, 0),
        ("m", FEET_UP, METRE, METRE, 0),
        ("m", FEET_UP, US_SURVEY_FOOT, US_SURVEY_FOOT, 0),
        (None, None, FOOT, FOOT, 0),
        ("m", None, METRE, METRE, 0),
        ("counts", None, None, None, 1),
        ("counts", FEET_UP, None, US_SURVEY_FOOT, 0),
        ("counts", None, FOOT, FOOT, 0),
    ],
)
def test_the_unit_is_that_of_band_axis_or_caller(word, crs, declared, unit, n_notes):
    raster = header(units=[None, word])
    found, notes = reading.find_elevation_unit(raster, 2, crs, declared)
    assert (found, len(notes)) == (unit, n_notes)
    if notes:
        assert notes == ["The unit of band 2, 'counts', is no length: the elevations have none."]


def test_two_units_are_refused_until_one_is_declared():
    raster = header(units=["m", None])
    said = sentence_of(ReadError, reading.find_elevation_unit, raster, 1, FEET_UP, None)
    assert said == (
        "the file gives its elevations two units: metre (of band 1) and US survey foot (of the "
        "vertical axis of its CRS); declare the one that is right."
    )
