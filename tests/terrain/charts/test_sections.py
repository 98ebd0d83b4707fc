"""The sheet of cross sections."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts

pytest.importorskip("matplotlib")

GROUND = ts.triangulate([[0, 0, 2], [40, 0, 6], [40, 40, 6], [0, 40, 2]])
DESIGN = GROUND.replace(points=GROUND.points + np.array([0, 0, 0.5]))
AXIS = [[2, 20], [38, 20]]


def cut(*tins, **how):
    surfaces = dict(zip(("ground", "design"), tins, strict=False)) if len(tins) > 1 else tins[0]
    return ts.cross_sections(surfaces, AXIS, **{"interval": 10, "width": 20} | how)


def titles(figure):
    return [(axes.get_title(loc="left"), axes.get_title(loc="right")) for axes in figure.axes]


def test_each_section_has_its_station_and_elevations_on_the_centreline():
    figure = ts.section_picture(cut(GROUND, DESIGN))
    assert titles(figure)[1] == ("Station 10.00", "ground 3.20, design 3.70 (+0.50)")
    assert [one[0] for one in titles(figure)] == [
        "Station 0.00", "Station 10.00", "Station 20.00", "Station 30.00", "Station 36.00"
    ]  # fmt: skip


def test_all_sections_have_one_scale_and_hold_their_surfaces():
    figure = ts.section_picture(cut(GROUND, DESIGN), columns=3)
    spans = [np.ptp(axes.get_ylim()) for axes in figure.axes]
    np.testing.assert_allclose(spans, spans[0], rtol=1e-9)
    for axes in figure.axes:
        assert axes.get_xlim() == (-10, 10)
        low, high = axes.get_ylim()
        for line in axes.get_lines():
            heights = line.get_ydata()
            if len(heights) > 2:
                assert low <= min(heights)
                assert max(heights) <= high


def test_the_exaggeration_is_that_of_the_drawing():
    figure = ts.section_picture(cut(GROUND), exaggeration=4)
    axes = figure.axes[0]
    box = axes.get_position()
    width, height = figure.get_size_inches() * (box.width, box.height)
    across, up = np.ptp(axes.get_xlim()) / width, np.ptp(axes.get_ylim()) / height
    assert across / up == pytest.approx(4)


def test_units_stand_at_the_axes():
    metres = GROUND.replace(crs="EPSG:32616")
    figure = ts.section_picture(cut(metres), crs="EPSG:32616")
    assert figure.axes[0].get_ylabel() == "elevation, m assumed"
    assert figure.axes[-1].get_xlabel() == "offset, m"
    assert titles(figure)[0][0] == "Station 0.00 m"


def test_sections_without_surface_are_drawn_empty():
    table = ts.cross_sections(GROUND, [[-30, 20], [20, 20]], interval=25, width=10)
    figure = ts.section_picture(table)
    assert titles(figure)[0] == ("Station 0.00", "\N{EN DASH}")


def test_a_level_surface_is_drawn():
    level = ts.triangulate([[0, 0, 5], [40, 0, 5], [40, 40, 5], [0, 40, 5]])
    figure = ts.section_picture(cut(level))
    assert figure.axes[0].get_ylim()[0] < 5 < figure.axes[0].get_ylim()[1]


def test_cut_is_never_shaded_as_fill():
    """Where both surfaces agree but for a rounding, the shade of fill ran on over the cut."""
    table = ts.Table(
        {
            "line": np.zeros(4, int),
            "section": np.zeros(4, int),
            "station": np.zeros(4),
            "offset": np.array([-3.0, -1, 1, 3]),
            **{f"elevation_{name}": np.array(z) for name, z in SHADED.items()},
            **{f"crossed_{name}": np.array(["edge"] * 4) for name in SHADED},
        }
    )
    (axes,) = ts.section_picture(table).axes
    shades = {one.get_label(): one.get_paths() for one in axes.collections}
    ends = {"fill": (0.0, 1.0), "cut": (-1.0, 0.0)}
    for label, paths in shades.items():
        heights = np.concatenate([path.vertices for path in paths])[:, 1]
        assert (heights.min(), heights.max()) == ends[label]


SHADED = {"ground": [0.0, 0.0, 0.0, 0.0], "design": [1e-13, -1.0, 1.0, 1.0]}


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"line": 1}, "Invalid line 1"),
        ({"columns": 0}, "Invalid columns 0"),
        ({"columns": 2.5}, "Invalid columns 2.5"),
        ({"exaggeration": 0}, "Invalid exaggeration 0"),
        ({"exaggeration": 1e6}, "or less here"),
    ],
)
def test_wrong_options_are_refused(options, sentence):
    with pytest.raises(ts.OptionError, match=sentence):
        ts.section_picture(cut(GROUND), **options)


def test_what_is_no_table_of_sections_is_refused():
    with pytest.raises(ts.OptionError, match="a table that cross_sections returned"):
        ts.section_picture(ts.profile(GROUND, AXIS))
    with pytest.raises(ts.OptionError, match="at most 60 on a sheet"):
        ts.section_picture(cut(GROUND, interval=0.5))
