"""A TIN on axes of matplotlib: its own triangulation, and a plot, at map coordinates."""

from __future__ import annotations

import itertools

import matplotlib as mpl
import matplotlib.figure
import numpy as np
import pytest
from support.surfaces import hills

import tinsmith as ts

mpl.use("Agg")


@pytest.fixture
def axes():
    return matplotlib.figure.Figure().add_subplot()


@pytest.fixture(scope="module")
def tin():
    return hills(crs="EPSG:32616")


def test_filled_contours_of_matplotlib_are_the_bands_at_map_coordinates(tin, axes):
    """Its areas between levels, from its own algorithm, are those of contour_bands."""
    triangles = ts.to_matplotlib(tin)
    np.testing.assert_array_equal(triangles.triangles, tin.triangles)
    low, high = tin.points[:, 2].min(), tin.points[:, 2].max()
    levels = np.linspace(low, high, 6)[1:-1]
    drawn = axes.tricontourf(triangles, tin.points[:, 2], levels=levels)
    found = [_measure(path) for path in drawn.get_paths()]
    bands = ts.contour_bands(tin, levels=levels)
    area = {
        (a, b): area
        for a, b, area in zip(
            bands.columns["from"], bands.columns["to"], bands.columns["area"], strict=True
        )
    }
    inner = [area[pair] for pair in itertools.pairwise(levels)]
    assert found == pytest.approx(inner, rel=1e-6)
    axes.triplot(triangles)
    axes.tripcolor(triangles, tin.points[:, 2])


def _measure(path):
    total = 0.0
    for ring in path.to_polygons(closed_only=True):
        x, y = (ring - ring[0]).T
        total += 0.5 * float(np.dot(x[:-1], y[1:]) - np.dot(x[1:], y[:-1]))
    return abs(total)


@pytest.mark.parametrize("values", ["elevation", "slope", None, "vertices", "triangles"])
def test_plot(tin, axes, values):
    numbers = {"vertices": np.arange(len(tin.points)), "triangles": np.arange(len(tin))}
    chosen = None if values is None else numbers.get(values, values)
    drawn = tin.plot(axes, values=chosen, cmap="terrain")
    assert drawn is axes
    west, east = axes.get_xlim()
    assert west <= tin.bounds.xmin < tin.bounds.xmax <= east
    assert axes.get_aspect() == 1.0
    assert axes.get_xlabel() == "easting, m"
    axes.figure.canvas.draw()
    assert all("e" not in label.get_text() for label in axes.get_xticklabels())
    assert "+" not in axes.xaxis.get_offset_text().get_text()


def test_plot_on_new_axes_has_a_scale(tin):
    import matplotlib.pyplot as plt

    axes = tin.plot(values="slope", edges=False, lines=False)
    assert [one.get_ylabel() for one in axes.figure.axes if one is not axes] == ["slope, degrees"]
    assert len(axes.collections) == 1
    alone = tin.plot(colorbar=False)
    assert len(alone.figure.axes) == 1
    plt.close("all")


def test_lines_are_drawn_by_their_kind(tin, axes):
    with_lines = tin.plot(axes, values=None, edges=False)
    assert len(with_lines.collections) == len(set(tin.lines.kinds))


def test_longitude_and_latitude_are_drawn_true_to_scale(axes):
    tin = ts.triangulate([[8, 60, 1], [8.1, 60, 2], [8, 60.1, 3]], crs="EPSG:4326")
    assert tin.plot(axes).get_aspect() == pytest.approx(2.0, rel=0.01)


@pytest.mark.parametrize("values", ["height", np.arange(2), [[1, 2]], object(), ["a"]])
def test_values_that_are_none_are_refused(tin, axes, values):
    with pytest.raises(ts.OptionError, match="Invalid values"):
        tin.plot(axes, values=values)


@pytest.mark.parametrize("other", [np.zeros((2, 2)), "axes", matplotlib.figure.Figure()])
def test_what_is_no_axes_is_refused(tin, other):
    with pytest.raises(ts.OptionError, match=r"^Invalid ax .*axes of a matplotlib figure"):
        tin.plot(other)
