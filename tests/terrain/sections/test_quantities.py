"""Areas of sections, volumes between them and mass haul against closed forms and ts.volume."""

import math

import numpy as np
import pytest

import tinsmith as ts


def plane(z, size=400.0, **more):
    """A square around the origin whose elevations are a function of x and y, at its corners."""
    corners = np.array([[-size, -size], [size, -size], [size, size], [-size, size]])
    heights = [z(x, y) for x, y in corners]
    return ts.triangulate(np.column_stack([corners, heights]), **more)


LEVEL = plane(lambda x, y: 0.0)


def test_a_wedge_has_the_volumes_of_a_wedge():
    design = plane(lambda x, y: x / 10)
    table = ts.section_volumes(LEVEL, design, [[-50, 0], [150, 0]], interval=50, left=4, right=6)
    at = table["station"] - 50.0
    np.testing.assert_allclose(table["fill_area"], 10 * np.maximum(at, 0) / 10, atol=1e-12)
    np.testing.assert_allclose(table["cut_area"], 10 * np.maximum(-at, 0) / 10, atol=1e-12)
    for kind in ("volume", "prismoidal", "end_area"):
        assert table[f"fill_{kind}"].sum() == pytest.approx(150**2 / 2, rel=1e-12)
        assert table[f"cut_{kind}"].sum() == pytest.approx(50**2 / 2, rel=1e-12)
    assert table["mass"][-1] == pytest.approx(50**2 / 2 - 150**2 / 2)


def test_sections_that_change_sign_are_split_where_they_do():
    design = plane(lambda x, y: y / 4)
    table = ts.section_volumes(LEVEL, design, [[0, 0], [40, 0]], interval=40, left=8, right=4)
    # to the left (y > 0) it rises above the ground, to the right it falls below it
    np.testing.assert_allclose(table["fill_area"], 8 * 2 / 2)
    np.testing.assert_allclose(table["cut_area"], 4 * 1 / 2)


def test_volumes_on_a_curve_are_those_of_the_ring():
    road = ts.Alignment([ts.Element("arc", (100.0, 0.0), math.pi / 2, 150.0, 0.01, 0.01)])
    table = ts.section_volumes(LEVEL, plane(lambda x, y: 2.0), road, interval=10, left=5, right=9)
    ring = (109**2 - 95**2) / 2 * 1.5 * 2.0
    # Chords of a curve lie within a millimetre of it.
    assert table["fill_total"][-1] == pytest.approx(ring, rel=1e-4)
    # By areas the strip is as long as the axis, whatever lies to either side of it.
    assert table["fill_end_area"].sum() == pytest.approx(14 * 150 * 2.0)


def test_totals_do_not_depend_on_the_sections():
    rng = np.random.default_rng(3)
    ground, design = (
        ts.triangulate(np.column_stack([rng.uniform(-50, 250, (400, 2)), rng.uniform(0, 9, 400)]))
        for _ in range(2)
    )
    corners = [[0, 0], [80, 10], [120, 90], [200, 100]]
    road = ts.Alignment.from_points(corners, radii=30, transitions=10)
    totals = []
    for interval in (100.0, 20.0, 7.0):
        table = ts.section_volumes(ground, design, road, interval=interval, width=16)
        totals.append([table[f"{word}_total"][-1] for word in ("cut", "fill")])
        np.testing.assert_allclose(table["mass"], table["cut_total"] - table["fill_total"])
    np.testing.assert_allclose(totals, totals[:1] * 3, rtol=1e-4)
    fine = [float(table[f"{word}_prismoidal"].sum()) for word in ("cut", "fill")]
    np.testing.assert_allclose(fine, totals[-1], rtol=0.05)


def test_factors_of_swell_and_shrinkage_weigh_the_masses():
    design = plane(lambda x, y: x / 10)
    line = [[-50, 0], [50, 0]]
    how = {"interval": 25, "width": 4, "shrink_factor": 0.9, "swell_factor": 1.25}
    table = ts.section_volumes(LEVEL, design, line, **how)
    expected = 0.9 * table["cut_total"] - table["fill_total"]
    np.testing.assert_allclose(table["mass"], expected)
    np.testing.assert_allclose(table["loose"], 1.25 * table["cut_total"])


def test_balanced_stations_are_told():
    design = plane(lambda x, y: x / 10)
    table = ts.section_volumes(LEVEL, design, [[-50, 0], [150, 0]], interval=10, width=4)
    assert any("Mass is balanced at the stations 100.000" in note for note in table.notes)


def test_sections_that_cross_in_a_bend_have_no_strip_and_this_is_told():
    line = [[0, 0], [40, 0], [0, 4]]
    table = ts.section_volumes(LEVEL, plane(lambda x, y: 1.0), line, interval=5, width=60)
    missing = np.isnan(table["fill_volume"])
    assert missing.any()
    assert any("totals count the mean of both areas" in note for note in table.notes)
    assert np.isfinite(table["fill_total"]).all()


def test_elevations_in_feet_above_metres_become_cubic_metres():
    how = {"crs": "EPSG:32616", "elevation_unit": "ft"}
    surfaces = (plane(lambda x, y, z=z: z, **how) for z in (0.0, 10.0))
    table = ts.section_volumes(*surfaces, [[0, 0], [100, 0]], interval=50, width=10)
    assert table["fill_area"].tolist() == pytest.approx([10 * 3.048] * 3)
    assert table["fill_total"][-1] == pytest.approx(1000 * 3.048)
    assert table.units["fill_total"] is not None


def test_written_stations_stand_beside_the_lengths():
    jump = ts.StationEquation(40.0, ahead=500.0)
    road = ts.Alignment.from_points([[0, 0], [100, 0]], equations=[jump])
    table = ts.section_volumes(LEVEL, plane(lambda x, y: 1.0), road, interval=20, width=4)
    assert table["written_station"].tolist() == [0, 20, 500, 520, 540, 560]


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({"interval": 10, "width": 4, "shrink_factor": 0}, "shrink_factor"),
        ({"interval": 10}, "width"),
        ({"width": 4}, "interval"),
        ({"stations": [5.0], "width": 4}, "between two"),
        ({"stations": [5000.0, 6000.0], "width": 4}, "on the centreline"),
        ({"interval": 10, "width": 4, "threads": 0}, "threads"),
    ],
)
def test_what_cannot_be_measured_is_refused(how, words):
    with pytest.raises(ts.TinsmithError, match=words):
        ts.section_volumes(LEVEL, LEVEL, [[0, 0], [50, 0]], **how)


def test_several_lines_are_refused():
    lines = [[[0, 0], [50, 0]], [[0, 9], [50, 9]]]
    with pytest.raises(ts.LinesError, match="one is needed"):
        ts.section_volumes(LEVEL, LEVEL, lines, interval=10, width=4)
    road = ts.Alignment.from_points([[0, 0], [50, 0]])
    with pytest.raises(ts.OptionError, match="stations of its own"):
        ts.section_volumes(LEVEL, LEVEL, road, interval=10, width=4, start=5.0)


def test_the_diagram_is_drawn_of_such_a_table_only():
    table = ts.section_volumes(
        LEVEL, plane(lambda x, y: x / 10), [[-50, 0], [50, 0]], interval=10, width=4
    )
    figure = ts.mass_haul_picture(table, title="Main road")
    assert [axes.get_ylabel() for axes in figure.axes] == ["area, cut above fill", "mass"]
    with pytest.raises(ts.OptionError, match="section_volumes"):
        ts.mass_haul_picture(ts.Table({"station": [1.0]}))
