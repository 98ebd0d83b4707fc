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
    return ts.triangulate(np.column_stack([xy, z]), crs="EPSG:32616", elevation_unit="m")


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


def measure_rings(path):
    """Sum the signed areas of the rings that a path draws, each closed."""
    rings = path.to_polygons(closed_only=False)
    assert all((ring[0] == ring[-1]).all() for ring in rings)
    return sum(
        (x[:-1] * y[1:] - x[1:] * y[:-1]).sum() / 2 for x, y in ((r - r[0]).T for r in rings)
    )


def test_bands_are_drawn_with_all_their_rings_in_colors_of_the_scale(tin):
    bands = ts.contour_bands(tin, interval=2)
    axes, bar = ts.contour_map(tin, bands=bands).axes
    patches = [patch for patch in axes.patches if isinstance(patch, PathPatch)]
    (mesh,) = bar.collections[-1:]
    colors = mesh.cmap(mesh.norm((bands.columns["from"] + bands.columns["to"]) / 2))
    for patch, area, color in zip(patches, bands.columns["area"], colors, strict=True):
        assert measure_rings(patch.get_path()) == pytest.approx(area, rel=1e-6)
        assert patch.get_facecolor()[:3] == pytest.approx(color[:3])


def test_lines_lie_where_they_are_and_index_contours_are_bold(tin):
    lines = ts.contours(tin, interval=1)
    (axes,) = ts.contour_map(tin, lines).axes
    (drawn,) = (one for one in axes.collections if isinstance(one, LineCollection))
    offsets = lines.offsets[0]
    for path, first, last in zip(drawn.get_paths(), offsets[:-1], offsets[1:], strict=True):
        assert np.array_equal(path.vertices, lines.coordinates[first:last, :2])
    widths, is_index = np.asarray(drawn.get_linewidths()), lines.columns["is_index"]
    assert widths[is_index].min() > 1.5 * widths[~is_index].max()


def test_labels_lie_on_the_map_where_they_are_given(tin):
    lines = ts.contours(tin, interval=1)
    labels = ts.contour_labels(lines)
    (axes,) = ts.contour_map(tin, lines, labels=labels).axes
    columns = labels.columns
    wanted = zip(columns["text"], labels.coordinates, columns["rotation"], strict=True)
    for text, (words, place, rotation) in zip(axes.texts, wanted, strict=True):
        assert text.get_text() == words
        assert text.get_position() == tuple(place[:2])
        assert abs((text.get_rotation() - rotation + 180) % 360 - 180) < 2  # by the pixel


def test_the_map_holds_the_surface_true_to_scale(tin):
    (axes,) = ts.contour_map(tin, ts.contours(tin, interval=1)).axes
    bounds = tin.bounds
    for (low, high), least, most in (
        (axes.get_xlim(), bounds.xmin, bounds.xmax), (axes.get_ylim(), bounds.ymin, bounds.ymax),
    ):  # fmt: skip
        assert low < least
        assert most < high
        assert high - low < 1.2 * (most - least)
    box = axes.get_window_extent()
    per_x = box.width / np.diff(axes.get_xlim())
    assert per_x == pytest.approx(box.height / np.diff(axes.get_ylim()), rel=0.02)
    for axis, places in ((axes.xaxis, axes.get_xticks()), (axes.yaxis, axes.get_yticks())):
        texts = [text.get_text() for text in axis.get_ticklabels()]
        assert len(texts) >= 2
        assert [float(text.replace(",", "")) for text in texts] == pytest.approx(places)


@pytest.mark.parametrize("interval", [0.5, 4.0])
def test_the_caption_says_the_steps_that_are_drawn(tin, interval):
    lines = ts.contours(tin, interval=interval, index=3)
    (axes,) = ts.contour_map(tin, lines).axes
    said = axes.get_title(loc="left")
    assert f"every {interval:g} m" in said
    marked = np.unique(lines.columns["elevation"][lines.columns["is_index"]])
    if len(marked) > 1:
        assert f"index contours every {3 * interval:g} m" in said
