"""The contour map shows what it was given."""

from __future__ import annotations

import io

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.patches import PathPatch

import tinsmith as ts


@pytest.fixture(scope="module")
def tin():
    rng = np.random.default_rng(1)
    xy = rng.uniform((500_000, 4_000_000), (500_100, 4_000_100), (400, 2))
    z = 300 + 8 * np.sin(xy[:, 0] / 15) * np.cos(xy[:, 1] / 12)
    return ts.triangulate(np.column_stack([xy, z]), crs="EPSG:32616", z_unit="m")


def test_lines_labels_and_units_are_shown(tin):
    lines = ts.contours(tin, interval=1)
    (axes,) = ts.contour_map(tin, lines, title="A site").axes
    (drawn,) = (one for one in axes.collections if isinstance(one, LineCollection))
    assert len(drawn.get_paths()) == len(lines)
    assert {text.get_text() for text in axes.texts} == set(ts.contour_labels(lines).columns["text"])
    assert axes.get_xlabel().startswith("easting, m\nWGS 84 / UTM zone 16N")
    assert axes.get_title(loc="left") == "Contours every 1 m, index contours every 5 m"


def test_bands_have_a_scale_with_their_bounds(tin):
    bands = ts.contour_bands(tin, interval=2)
    axes, bar = ts.contour_map(tin, bands=bands).axes
    assert sum(isinstance(patch, PathPatch) for patch in axes.patches) == len(bands)
    assert bar.get_ylabel() == "elevation, m"
    assert bar.get_ylim() == (bands.columns["from"][0], bands.columns["to"][-1])


def test_open_bands_are_drawn(tin):
    bands = ts.contour_bands(tin, levels=[296, 300])
    assert ts.contour_map(tin, bands=bands).axes[1].get_ylim() == (292, 304)


def test_the_picture_is_drawn_without_a_screen(tin):
    png = io.BytesIO()
    ts.contour_map(tin, ts.contours(tin, interval=100)).savefig(png, format="png", dpi=40)
    assert png.getvalue().startswith(b"\x89PNG")
