"""Stakeout: heights by planes, names of points, reasons, layouts, units, points along an axis."""

import numpy as np
import pytest

import tinsmith as ts

CORNERS = np.array([[0.0, 0], [100, 0], [100, 80], [0, 80]])


def plane(z0, east=0.0, north=0.0, size=1.0, **how):
    xy = CORNERS * size
    return ts.triangulate(np.column_stack([xy, z0 + xy @ [east, north]]), **how)


DESIGN, GROUND = plane(10.0, 0.1, -0.05), plane(12.0, 0.0, 0.02)


def test_heights_cut_and_fill_are_those_of_the_planes():
    xy = np.random.default_rng(2).random((200, 2)) * [100, 80]
    table = ts.stakeout(DESIGN, xy, ground=GROUND)
    design, ground = 10 + xy @ [0.1, -0.05], 12 + xy @ [0.0, 0.02]
    assert table["elevation"] == pytest.approx(design, abs=1e-12)
    assert table["ground"] == pytest.approx(ground, abs=1e-12)
    assert table["cut"] - table["fill"] == pytest.approx(ground - design, abs=1e-12)
    assert (np.minimum(table["cut"], table["fill"]) == 0).all()
    assert not any(table["reason"])
    assert table["point"].tolist()[:3] == ["1", "2", "3"]


def test_points_outside_are_named_with_a_reason():
    survey = ts.Survey(
        points=[[5, 5, 0], [200, 5, 0], [5, 5.5, 0], [-1, 2, 0]],
        attributes={"number": ["A7", "A8", "A9", "B1"], "description": ["peg", "", None, "nail"]},
    )
    table = ts.stakeout(DESIGN, survey)
    assert table["point"].tolist() == ["A7", "A8", "A9", "B1"]
    assert table["description"].tolist() == ["peg", "", "", "nail"]
    assert np.isnan(table["elevation"]).tolist() == [False, True, False, True]
    assert table["reason"].tolist() == [None, "outside the design", None, "outside the design"]
    assert "2 of 4 points are outside the design: A8, B1." in table.notes
    small = plane(1.0, size=0.5)
    both = ts.stakeout(DESIGN, [[10, 10], [90, 70], [500, 0]], ground=small)
    assert both["reason"].tolist() == [
        None,
        "outside the ground",
        "outside the design; outside the ground",
    ]
    assert np.isnan(both["cut"]).tolist() == [False, True, True]


def test_what_was_found_in_the_points_is_told_in_the_list(tmp_path):
    file = tmp_path / "points.csv"
    file.write_text(
        "number,easting,northing,elevation\n101,10,10,1\n,20,10,1\n103,10,40,1\n104,30,30,\n"
    )
    survey = ts.read(file)
    road = ts.Alignment.from_points([[0, 0], [50, 0], [50, 80]])
    shown = ts.Features.of_points(survey.points, columns={"number": survey.attributes["number"]})
    for points in (survey, shown.with_notes(survey.notes)):
        table = ts.stakeout(DESIGN, points, alignment=road)
        assert table["point"].tolist() == ["101", "2", "103"]  # not 101.0
        assert "1 point has no number, and the number of its row instead (first: 2)." in table.notes
        assert any("line 5" in note for note in table.notes)  # 104, which has no elevation
        assert any("as near to another place" in note for note in table.notes)
    noted = road.stations_of(shown.with_notes(["Seen."]))
    assert "Seen." in noted.notes


def test_points_along_an_axis_have_its_stations_and_offsets():
    road = ts.Alignment.from_points(
        [[5, 40], [60, 40], [90, 70]],
        radii=20,
        start=1000.0,
        equations=[ts.StationEquation(1030.0, ahead=2000.0)],
    )
    table = ts.stakeout(DESIGN, alignment=road, stations=[1000, 1040], offsets=[-4.0, 0, 4.0])
    assert table["station"].tolist() == [1000.0] * 3 + [1040.0] * 3
    assert table["written_station"].tolist() == [1000.0] * 3 + [2010.0] * 3
    assert table["offset"].tolist() == [-4.0, 0.0, 4.0] * 2
    assert table["description"].tolist()[:4] == [
        "1000.000 L 4.000",
        "1000.000 CL",
        "1000.000 R 4.000",
        "2010.000 L 4.000",
    ]
    xy = np.column_stack([table["easting"], table["northing"]])
    assert xy[:3] == pytest.approx(np.array([[5, 44], [5, 40], [5, 36]]))
    again = ts.stakeout(DESIGN, xy, alignment=road)
    assert again["station"] == pytest.approx(table["station"], abs=1e-9)
    assert again["offset"] == pytest.approx(table["offset"], abs=1e-9)
    every = ts.stakeout(DESIGN, alignment=road, interval=10.0)
    assert every["station"] == pytest.approx(road.tabulate_points(10.0)["station"])
    beyond = ts.stakeout(DESIGN, [[1, 40.0]], alignment=road)
    assert beyond["reason"].tolist() == ["before the start or beyond the end of the alignment"]


def test_a_layout_chooses_and_orders_the_columns():
    points = [[5.0, 6.0], [300.0, 7.0]]
    table = ts.stakeout(DESIGN, points, layout="pnezd")
    assert list(table.columns) == ["point", "northing", "easting", "elevation", "description"]
    assert table["northing"].tolist() == [6.0, 7.0]
    assert "1 of 2 points is outside the design: 2." in table.notes
    other = ts.stakeout(DESIGN, points, ground=GROUND, layout="PENZGCFR")
    assert list(other.columns)[:3] == ["point", "easting", "northing"]
    for layout in ("", "PNEZX", "PPNE", "PC", "PS", 7):
        with pytest.raises(ts.OptionError, match="layout"):
            ts.stakeout(DESIGN, points, layout=layout)


def test_lengths_are_in_the_unit_asked_for():
    how = {"crs": "EPSG:2274", "elevation_unit": "m"}
    xy = CORNERS + np.array([2e6, 5e5])
    design = ts.triangulate(np.column_stack([xy, np.full(4, 30.0)]), **how)
    feet = ts.triangulate(
        np.column_stack([xy, np.full(4, 100.0)]), crs="EPSG:2274", elevation_unit="ft"
    )
    table = ts.stakeout(design, xy[:1] + 1.0, ground=feet)
    assert table["ground"] == pytest.approx([30.48])
    assert table.units["elevation"].name == "metre"
    assert table.units["easting"].name == "US survey foot"
    metres = ts.stakeout(design, xy[:1] + 1.0, ground=feet, unit="m")
    assert metres["easting"] == pytest.approx([(2e6 + 1) * 1200 / 3937])
    assert metres["cut"] == pytest.approx([0.48])
    assert {str(one) for one in metres.units.values()} == {"metre"}
    with pytest.raises(ts.OptionError, match="unit of the CRS is not known"):
        ts.stakeout(DESIGN, [[1, 1]], unit="m")


def test_axes_have_the_names_of_the_crs():
    xy = CORNERS + np.array([20_000.0, 3_700_000.0])
    design = ts.triangulate(
        np.column_stack([xy, np.full(4, 30.0)]), crs="EPSG:2048", elevation_unit="m"
    )
    table = ts.stakeout(design, xy[:1] + 1.0)
    assert list(table.columns)[1:3] == ["westing", "southing"]


def test_coordinates_on_the_ground_are_those_of_the_factor():
    xy = CORNERS + np.array([750_000.0, 4_020_000.0])
    design = ts.triangulate(
        np.column_stack([xy, np.full(4, 30.0)]), crs="EPSG:32616", elevation_unit="m"
    )
    factor = ts.combined_factor(design, point=xy[0])
    grid, ground = (ts.stakeout(design, xy, factor=one) for one in (None, factor))
    east, north = (ground[name] - grid[name][0] for name in ("easting", "northing"))
    assert np.hypot(east, north)[2] == pytest.approx(np.hypot(100, 80) / factor.combined, abs=1e-9)
    assert ground["elevation"].tolist() == grid["elevation"].tolist()
    assert any("on the ground" in note for note in ground.notes)
    points = ts.stake_points(ground, crs=factor.ground_crs)
    assert points.crs.is_same(factor.ground_crs)


def test_lists_become_points_with_labels(tmp_path):
    ezdxf = pytest.importorskip("ezdxf")
    table = ts.stakeout(DESIGN, [[5.0, 6.0], [95.0, 7.0], [300.0, 7.0]], ground=GROUND)
    points = ts.stake_points(table)
    assert points.columns["cut_fill"].tolist() == ["C 1.920", "F 7.010", None]
    assert points.coordinates[:2, 2] == pytest.approx(table["elevation"][:2])
    with pytest.warns(ts.LossWarning):
        ts.write(points, tmp_path / "stakes.dxf")
    document = ezdxf.readfile(tmp_path / "stakes.dxf")
    assert not document.audit().errors
    texts = {one.dxf.text for one in document.modelspace().query("TEXT")}
    assert {"1", "2", "3", "10.20"} <= texts
    with pytest.raises(ts.OptionError, match="layout"):
        ts.stake_points(ts.stakeout(DESIGN, [[5.0, 6.0]], layout="PNEZD"))


@pytest.mark.parametrize(
    ("how", "word"),
    [
        ({}, "points"),
        ({"points": [[1, 1]], "stations": [1.0]}, "points"),
        ({"stations": [1.0]}, "alignment"),
        ({"points": [[1, 1]], "alignment": "road"}, "alignment"),
        ({"points": ts.Features.of_lines([[0, 0], [1, 1]], [0, 2])}, "points"),
    ],
)
def test_what_cannot_be_is_refused(how, word):
    with pytest.raises(ts.OptionError, match=word):
        ts.stakeout(DESIGN, **how)


def test_repeated_numbers_are_told():
    survey = ts.Survey(points=[[5, 5, 0], [6, 5, 0]], attributes={"number": [7, 7]})
    assert "1 point number occurs several times (first: '7')." in ts.stakeout(DESIGN, survey).notes
    with pytest.raises(ts.PointsError, match="no point"):
        ts.stakeout(DESIGN, np.zeros((0, 2)))
