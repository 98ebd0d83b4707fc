"""The histogram of triangle shapes: its words, axes, ticks and marks."""

from __future__ import annotations

import numpy as np
import pytest

from tinsmith import TIN
from tinsmith.terrain import histogram
from tinsmith.terrain.charts.histogram import _choose_log_ticks
from tinsmith.tin import Quality, quality

pytest.importorskip("matplotlib")

TILES = [(4, 3), (40, 30), (2, 9), (30, 1), (12, 5), (7, 24), (8, 15)]


def strip():
    """Right triangles side by side, each with legs of its own: shapes that one can reckon."""
    points, triangles = [], []
    for k, (width, height) in enumerate(TILES):
        x = 100.0 * k
        points += [[x, 0, 0], [x + width, 0, 0], [x, height, 0]]
        triangles.append([3 * k, 3 * k + 1, 3 * k + 2])
    return TIN.from_triangles(points, triangles)


def panels(**options):
    return histogram(quality(strip()), **options).axes


def test_the_heading_says_what_and_how_it_is_measured():
    plane, space = (
        histogram(quality(strip(), space=space), title=title)
        for space, title in ((False, None), (True, "Site\n 7"))
    )
    assert plane.get_suptitle() == "Triangle quality"
    assert plane.get_supxlabel() == "7 triangles, measured in the plane"
    assert space.get_suptitle() == "Site 7"
    assert space.get_supxlabel() == "7 triangles, measured in space"
    assert plane.get_size_inches().tolist() == [11.0, 7.0]


def test_each_panel_says_its_range_its_unit_and_its_share():
    found = quality(strip())
    said = [(one.get_title(loc="left"), one.get_title(loc="right")) for one in panels(unit="m")]
    assert said == [
        ("Smallest angle", f"1.91 to 36.9°, {100 * 3 / 7:.1f} % below 20°"),
        ("Largest angle", "90 to 90°, 0.0 % above 120°"),
        ("Aspect ratio", f"{found.aspect_ratio.min():.3g} to {found.aspect_ratio.max():.3g}"),
        ("Edge length", "1 to 50 m"),
    ]
    assert panels()[3].get_title(loc="right") == "1 to 50"


def test_shares_count_what_lies_beyond_the_limit_and_not_on_it():
    shapes = Quality(
        min_angle=np.array([20.0, 19.9, 20.1, 60.0, 5.0]),
        max_angle=np.array([120.0, 120.1, 119.9, 60.0, 90.0]),
        aspect_ratio=np.ones(5),
        edge_lengths=np.ones((5, 3)),
        circumradius=np.ones(5),
        radius_edge=np.ones(5),
        space=False,
    )
    said = [axes.get_title(loc="right") for axes in histogram(shapes).axes]
    assert said == [
        "5 to 60°, 40.0 % below 20°",
        "60 to 120°, 20.0 % above 120°",
        "1 to 1",
        "1 to 1",
    ]


@pytest.mark.parametrize(
    ("value", "words"),
    [(0.5, "0.5"), (999.6, "1e+03"), (1000.0, "1,000"), (123_456.0, "123,456"), (1e9, "1e+09")],
)
def test_numbers_are_short_and_large_ones_are_grouped(value, words):
    side = value
    tin = TIN.from_triangles([[0, 0, 0], [side, 0, 0], [0, side, 0]], [[0, 1, 2]])
    length = histogram(quality(tin)).axes[3]
    assert length.get_title(loc="right").startswith(f"{words} to ")
    assert length.texts[0].get_text() == f"median {words}"


def test_the_median_is_marked_where_it_is_with_room_for_its_words():
    found = quality(strip())
    measures = found.min_angle, found.max_angle, found.aspect_ratio, found.edge_lengths.ravel()
    for axes, values in zip(panels(unit="ft"), measures, strict=True):
        middle = np.sort(values)[(len(values) - 1) // 2]
        (line,) = axes.lines
        assert line.get_xdata() == [middle, middle]
        (note,) = axes.texts
        assert note.xy == (middle, 1.0)
        low, high = axes.get_xlim()
        fraction = (middle - low) / (high - low)
        if axes.get_xscale() == "log":
            fraction = np.log(middle / low) / np.log(high / low)
        assert note.get_ha() == ("left" if fraction < 0.5 else "right")
        assert note.xyann == (5 if fraction < 0.5 else -5, -10)


def test_axes_span_the_bars_and_leave_room_above():
    for axes in panels():
        shares, edges, _ = axes.patches[0].get_data()
        assert len(shares) == 60
        assert axes.get_xlim() == (edges[0], edges[-1])
        assert axes.get_ylim() == pytest.approx((0.0, 1.14 * shares.max()))
        assert axes.get_ylabel() == "share, %"
        assert not axes.spines["top"].get_visible()
        assert not axes.spines["right"].get_visible()
        assert axes.get_axisbelow()
        assert axes.patches[0].get_fill()
    small, large, aspect, length = panels()
    assert (small.get_xlim(), large.get_xlim()) == ((0, 60), (60, 180))
    assert [axes.get_xscale() for axes in (small, large, aspect, length)] == [
        *("linear", "linear", "log", "log")
    ]
    assert aspect.get_xlim()[0] == 1.0
    assert length.get_xlim() == (1.0, 50.0)
    for axes in (aspect, length):
        edges = axes.patches[0].get_data()[1]
        ratios = edges[1:] / edges[:-1]
        np.testing.assert_allclose(ratios, ratios[0], rtol=1e-9)
        assert len(axes.get_xticks(minor=True)) == 0


def test_ticks_carry_the_unit_and_stand_within_the_axis():
    small, _, aspect, length = panels(unit="m")
    for axes, unit in ((small, "°"), (aspect, ""), (length, " m")):
        low, high = axes.get_xlim()
        places = axes.get_xticks()
        assert len(places) >= 3
        assert low <= places.min() < places.max() <= high
        words = [one.get_text() for one in axes.get_xticklabels()]
        assert words == [f"{place:g}{unit}" for place in places]
    assert length.get_xticks().tolist() == [1, 2, 5, 10, 20, 50]


def test_lengths_that_are_all_alike_still_have_an_axis():
    tin = TIN.from_triangles([[0, 0, 0], [4, 0, 0], [2, 12**0.5, 0]], [[0, 1, 2]])
    length = histogram(quality(tin)).axes[3]
    low, high = length.get_xlim()
    assert high == pytest.approx(1.5 * low)
    assert low <= 4.0 <= high
    ticks = length.get_xticks()
    assert len(ticks) >= 3
    assert ((ticks >= low) & (ticks <= high)).all()


def test_few_far_values_are_off_the_axis_and_told():
    """Of 1,500 lengths fewer than 0.2 % lie beyond the lower end, that many beyond the upper."""
    points, triangles = [], []
    for k in range(500):
        side = {0: 1e-3, 1: 1e5}.get(k, 1.0)
        x = 1e6 * k
        points += [[x, 0, 0], [x + side, 0, 0], [x, side, 0]]
        triangles.append([3 * k, 3 * k + 1, 3 * k + 2])
    length = histogram(quality(TIN.from_triangles(points, triangles)), unit="m").axes[3]
    assert length.get_title(loc="right").endswith("m, 0.33 % off the axis")
    assert length.get_xlim() == pytest.approx((2**0.5 * 1e-3, 2**0.5))


# ------------------------------------------------------------------ ticks of logarithmic axes


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [
        (1.0, 50.0, [1, 2, 5, 10, 20, 50]),
        (1.0, 100.0, [1, 2, 5, 10, 20, 50, 100]),
        (0.3, 30.0, [0.5, 1, 2, 5, 10, 20]),
        (1.0, 1000.0, [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000]),
        (1.0, 10_000.0, [1, 10, 100, 1000, 10_000]),
        (1.0, 1e9, [1, 1e2, 1e4, 1e6, 1e8]),
        (1.0, 1e8, [10.0**k for k in range(9)]),
        (2.0, 5.0, []),  # two would be too few
        (2.0, 10.0, [2, 5, 10]),
        (3.0, 4.0, []),
    ],
)
def test_ticks_of_a_logarithmic_axis_are_one_two_five_or_powers_alone(low, high, expected):
    assert _choose_log_ticks(low, high) == pytest.approx(expected)


@pytest.mark.parametrize("seed", range(40))
def test_ticks_of_any_logarithmic_axis_are_few_and_within(seed):
    rng = np.random.default_rng(seed)
    low = 10.0 ** rng.uniform(-6, 6)
    high = low * 10.0 ** rng.uniform(0.2, 18)
    places = _choose_log_ticks(low, high)
    assert len(places) == 0 or 3 <= len(places) <= 12
    assert all(low <= place <= high for place in places)
    assert places == sorted(set(places))
