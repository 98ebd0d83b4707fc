"""Pictures of profiles."""

import numpy as np
import pytest
from support.each_value import list_seeds

import tinsmith as ts

SQUARE = [[0, 0, 0], [40, 0, 4], [40, 40, 8], [0, 40, 4]]
TIN = ts.TIN.from_triangles(SQUARE, [[0, 1, 2], [0, 2, 3]])
LINE = [[1, 20], [39, 25]]


def texts(figure):
    return [text.get_text() for axes in figure.axes for text in axes.texts]


def drawn_exaggeration(figure):
    """Measure how much taller than wide a unit is drawn."""
    axes = figure.axes[0]
    box = axes.get_window_extent()
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    return (box.height / (high - low)) / (box.width / (right - left))


@pytest.mark.parametrize("exaggeration", [None, 1, 2.5, 10])
def test_the_exaggeration_is_what_it_says(exaggeration):
    figure = ts.profile_picture(ts.profile(TIN, LINE), exaggeration=exaggeration)
    said = next(text.get_text() for text in figure.texts if "exaggeration" in text.get_text())
    assert drawn_exaggeration(figure) == pytest.approx(float(said.rpartition(" ")[2]))
    if exaggeration is not None:
        assert drawn_exaggeration(figure) == pytest.approx(exaggeration)


def test_the_exaggeration_takes_both_units_into_account():
    feet = TIN.replace(crs="EPSG:32616", elevation_unit="ft")
    figure = ts.profile_picture(ts.profile(feet, LINE), exaggeration=10)
    assert drawn_exaggeration(figure) == pytest.approx(3.048)
    assert figure.axes[0].get_ylabel() == "elevation, ft"


def test_a_unit_that_is_not_known_is_called_assumed():
    table = ts.profile(TIN.replace(crs="EPSG:32616"), LINE)
    figure = ts.profile_picture(table, crs="EPSG:32616")
    assert figure.axes[0].get_ylabel() == "elevation, m assumed"
    assert "station, m" in texts(figure)
    assert ts.profile_picture(ts.profile(TIN, LINE)).axes[0].get_ylabel() == "elevation"


def test_figures_below_are_those_of_the_surfaces():
    raised = TIN.replace(points=TIN.points + np.array([0, 0, 1.5]))
    table = ts.profile({"old": TIN, "new": raised}, LINE)
    found = texts(ts.profile_picture(table))
    x = 1 + 10 * 38 / np.hypot(38, 5)
    y = 20 + 10 * 5 / np.hypot(38, 5)
    assert f"{TIN.interpolate([[x, y]])[0]:.2f}" in found
    assert found.count("+1.50") >= 5
    assert {"old", "new", "difference"} <= set(found)


def test_gaps_are_dashes():
    found = texts(ts.profile_picture(ts.profile(TIN, [[1, 20], [80, 20]])))
    assert "\N{EN DASH}" in found


def test_a_level_surface_and_one_line_of_several():
    level = TIN.replace(points=TIN.points * np.array([1, 1, 0]))
    figure = ts.profile_picture(ts.profile(level, [LINE, [[5, 5], [6, 6]]]), line=1, title="B-B")
    assert figure.axes[0].get_xlim() == pytest.approx((0, 2**0.5))


@pytest.mark.parametrize(
    ("how", "why"),
    [
        ({"line": 7}, "line"),
        ({"line": "a"}, "line"),
        ({"exaggeration": 0}, "exaggeration"),
        ({"exaggeration": np.nan}, "exaggeration"),
        ({"exaggeration": 1e9}, "or less here"),
    ],
)
def test_what_cannot_be_drawn_is_refused(how, why):
    with pytest.raises(ts.OptionError, match=why):
        ts.profile_picture(ts.profile(TIN, LINE), **how)


def test_another_table_is_no_profile():
    with pytest.raises(ts.OptionError, match="profile"):
        ts.profile_picture(ts.Table({"a": [1.0]}))
    with pytest.raises(ts.OptionError, match="profile"):
        ts.profile_picture(ts.cross_sections(TIN, LINE, interval=5, width=4))
    with pytest.raises(ts.OptionError, match="meets a surface"):
        ts.profile_picture(ts.profile(TIN, [LINE, [[90, 90], [99, 99]]]), line=1)


def read_number(text):
    return float(text.replace(",", "").replace("\N{MINUS SIGN}", "-"))


@pytest.mark.parametrize("seed", list_seeds(12, few=4))
def test_ticks_stand_where_they_say_and_neither_crowded_nor_sparse(seed):
    rng = np.random.default_rng(seed)
    relief, length = 10.0 ** rng.uniform(-2, 3), 10.0 ** rng.uniform(1, 4)
    corners = np.array([[0, 0], [length, 0], [length, length], [0, length], [0.4, 0.5]])
    corners[4] *= length
    z = rng.uniform(-1e3, 1e3) + relief * rng.random(5)
    tin = ts.triangulate(np.column_stack([corners, z]))
    line = [[0.01 * length, 0.3 * length], [0.99 * length, 0.6 * length]]
    figure = ts.profile_picture(ts.profile(tin, line))
    axes = figure.axes[0]
    low, high = axes.get_ylim()
    places = axes.get_yticks()
    inches = axes.get_window_extent().height / figure.dpi * np.diff(places) / (high - low)
    assert len(places) >= 2
    assert ((places >= low) & (places <= high)).all()
    assert inches.min() > 0.25  # room for a label
    assert inches.max() < 1.3
    step = places[1] - places[0]
    for place, label in zip(places, axes.get_yticklabels(), strict=True):
        assert abs(read_number(label.get_text()) - place) <= 1e-6 * step
    drawn = np.concatenate([curve.get_ydata() for curve in axes.lines])
    assert low < np.nanmin(drawn)
    assert np.nanmax(drawn) < high
