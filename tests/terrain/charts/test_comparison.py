"""The picture of a comparison: what each panel draws, and the legend that explains it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_hex

import tinsmith as ts
from tinsmith.terrain import comparison_picture

GAP, INK, EDGE, UNEXTENDED = "#c9d1d8", "#333333", "#5b6670", "#1f5fbf"
COLORS = ["#ffffff", "#f2b134", "#c8371b"]


@cache
def compare(*shape):
    return ts.tin.compare(np.random.default_rng(9).random((40, 3)) * shape)


def compared(*, width=1.0, height=1.0, count=40):
    """A comparison of 40 points; those beyond are in no triangle."""
    shape = width, height, 1.0
    found = compare(*shape)
    more = np.random.default_rng(8).uniform(0.3, 0.6, (count - 40, 3)) * shape
    return replace(found, points=np.concatenate([found.points, more]))


@pytest.mark.parametrize(("count", "line"), [(40, 0.8), (301, 0.35)])
def test_a_panel_draws_all_triangles_edges_and_what_is_uncovered(count, line):
    found = compared(count=count)
    shown = comparison_picture(found).axes
    assert len(shown) == 5
    xy = found.points[:, :2] - found.points[:, :2].min(axis=0)
    for axes, outcome in zip(shown, found.outcomes, strict=True):
        (ground,) = axes.patches
        assert to_hex(ground.get_facecolor()) == GAP
        assert ground.get_linewidth() == line
        assert ground.get_zorder() == 1
        np.testing.assert_allclose(ground.get_xy()[:-1], xy[found.hull])
        *fills, edges, unextended = axes.collections
        chosen = [~outcome.violating, outcome.violating, outcome.overlapping]
        for fill, color, alpha, which in zip(fills, COLORS, (1.0, 1.0, 0.22), chosen, strict=True):
            assert isinstance(fill, PolyCollection)
            corners = [path.vertices[:3] for path in fill.get_paths()]
            np.testing.assert_allclose(
                np.reshape(corners, (-1, 3, 2)), xy[outcome.triangles[which]]
            )
            assert fill.get_alpha() == alpha
            assert to_hex(fill.get_facecolor()[0]) == color
            assert fill.get_linewidth() == 0
        sides = {frozenset((t[k - 1], t[k])) for t in outcome.triangles.tolist() for k in range(3)}
        drawn = [path.vertices for path in edges.get_paths()]
        expected = np.sort([xy[sorted(side)].ravel() for side in sides], axis=0)
        np.testing.assert_allclose(np.sort(np.reshape(drawn, (-1, 4)), axis=0), expected)
        assert isinstance(unextended, LineCollection)
        assert len(unextended.get_paths()) == len(outcome.unextended)
        assert (edges.get_linewidth(), unextended.get_linewidth()) == pytest.approx(
            (line, 3 * line)
        )
        assert to_hex(edges.get_color()[0]) == EDGE
        assert edges.get_zorder() == unextended.get_zorder() == 3
        assert not axes.axison
        assert axes.get_aspect() == 1.0


@pytest.mark.parametrize(("count", "is_drawn"), [(300, True), (301, False)])
def test_points_are_drawn_unless_they_would_be_a_crowd(count, is_drawn):
    for axes in comparison_picture(compared(count=count)).axes:
        assert len(axes.lines) == is_drawn
        for line in axes.lines:
            assert len(line.get_xdata()) == count
            assert line.get_marker() == "."


@pytest.mark.parametrize(
    ("width", "height", "expected"), [(1, 1, 1.0), (1, 9, 1.5), (9, 1, 0.3), (4, 3, 0.75)]
)
def test_panels_have_the_shape_of_the_points_within_limits(width, height, expected):
    found = compared(width=width, height=height)
    spans = np.ptp(found.points[:, :2], axis=0)
    ratio = min(max(spans[1] / spans[0], 0.3), 1.5)
    assert ratio == pytest.approx(expected, rel=0.1)
    across, up = comparison_picture(found).get_size_inches()
    assert across == 17.0
    assert up == pytest.approx(2 * (17.0 / 3) * ratio + 2.0)


def test_the_title_is_the_number_of_points_or_what_is_asked_for():
    found = compared()
    assert comparison_picture(found).get_suptitle() == "40 points"
    assert comparison_picture(found, title=" a\n b ").get_suptitle() == "a b"


def test_a_caption_counts_and_says_where_an_algorithm_stopped():
    found = compared()
    first, *others = found.outcomes
    found = replace(found, outcomes=(*others, replace(first, is_stopped=True)))
    for axes, outcome in zip(comparison_picture(found).axes, found.outcomes, strict=True):
        count = len(outcome.triangles)
        stopped = ", stopped" if outcome.name == first.name else ""
        assert axes.get_title() == (
            f"{outcome.name}: {count} of {found.expected} triangles{stopped}\n"
            f"{outcome.violating.sum()} with a point in the circle, "
            f"{outcome.overlapping.sum()} overlapping"
        )


def test_the_legend_names_each_colour():
    figure = comparison_picture(compared())
    (legend,) = figure.legends
    words = [one.get_text() for one in legend.get_texts()]
    assert words == [
        *("empty circle", "point in the circle", "overlapping", "not covered", "edge not extended")
    ]
    handles = legend.legend_handles
    assert [to_hex(one.get_facecolor()) for one in handles[:4]] == [*COLORS, GAP]
    assert handles[2].get_alpha() == pytest.approx(0.44)
    assert to_hex(handles[4].get_color()) == UNEXTENDED
    assert not legend.get_frame_on()
