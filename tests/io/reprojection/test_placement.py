"""Points of a file in the CRS wanted: what is told of areas of use, whatever the format."""

import json

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.base.crs import CRS
from tinsmith.io.reprojection.crs_checks import checking_crs
from tinsmith.io.reprojection.placement import place

NORTH = np.array([0.0, 5e6, 0.0])
UTM, ZONE = CRS.of("EPSG:32616"), "EPSG:32616 (longitude -90 to -84, latitude 0 to 84)"
SITE = np.array(
    [[752700.0, 4024200.0, 320.0], [752710.0, 4024200.0, 321.0], [752700.0, 4024210.0, 322.0]]
)


def _place(points, source, target, **options):
    return place(points, source=source, target=target, **options).notes


def test_points_in_the_area_of_their_crs_are_not_told():
    assert _place(SITE, UTM, None) == _place(SITE, None, UTM) == ()


def test_points_outside_the_area_of_either_crs_are_told():
    far = SITE + NORTH
    told = (
        f"3 of 3 points lie outside the area of use of {ZONE}: check that the CRS is the right one."
    )
    assert _place(far, UTM, None) == _place(far, None, UTM) == (told,)
    assert _place(far, UTM, None, looks_at_area=False) == ()
    one = np.vstack([SITE, far[:1]])
    assert _place(one, UTM, None)[0].startswith("1 of 4 points lies outside")


def test_points_that_would_lie_inside_exchanged_are_refused_or_told():
    told = f"3 of 3 points lie outside the area of use of {ZONE} and, with easting and northing ex"
    with pytest.raises(ts.CrsError, match="in the other order; `check_crs=False` takes them"):
        _place(SITE[:, [1, 0, 2]], UTM, None)
    with checking_crs(False):
        assert _place(SITE[:, [1, 0, 2]], UTM, None)[0].startswith(told)
    few = np.vstack([SITE, SITE[:1, [1, 0, 2]]])
    assert "exchanged, inside: check the order" in _place(few, UTM, None)[0]


def test_degrees_under_a_crs_of_lengths_are_refused_and_taken_where_no_crs_is_named():
    degrees = np.array([[-84.2, 36.3, 320.0], [-84.201, 36.3, 321.0], [-84.2, 36.301, 322.0]])
    for order in ([0, 1, 2], [1, 0, 2]):
        with pytest.raises(ts.CrsError, match=r"as l.*in degrees, inside"):
            _place(degrees[:, order], UTM, UTM)
    assert "taken to be degrees of WGS 84" in _place(degrees, None, UTM)[0]


def test_local_coordinates_are_told():
    local = SITE - [752690.0, 4024190.0, 0.0] - [3000.0, 9000.0, 0.0]
    assert _place(local, UTM, None) == (
        "The points lie about the origin of EPSG:32616 (first: easting -2990, northing -8990), "
        "outside its area of use: check that they are no local coordinates, and no degrees.",
    )
    assert "outside the area of use" in _place(local, UTM, CRS.of("EPSG:2274"))[0]


def test_latitude_before_longitude_in_geojson_is_refused(tmp_path):
    features = [
        {"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": place}}
        for place in ([36.1, -84.2, 320], [36.1, -84.201, 321], [36.101, -84.2, 322])
    ]
    path = tmp_path / "swapped.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    with pytest.raises(ts.CrsError, match="exchanged, inside: the coordinates are in the other"):
        ts.read(path, crs="EPSG:32616")
    notes = ts.read(path, crs="EPSG:32616", check_crs=False).notes
    assert any("exchanged, inside: the coordinates are in the other order" in one for one in notes)


@pytest.mark.parametrize("suffix", ["gpkg", "las", "tif"])
def test_files_of_every_kind_tell_points_outside(tmp_path, suffix):
    path = tmp_path / f"far.{suffix}"
    survey = ts.Survey(points=SITE + NORTH, crs="EPSG:32616")
    if suffix == "tif":
        ts.write(ts.rasterize(ts.triangulate(survey), spacing=2.0), path)
    else:
        ts.write(survey, path)
    notes = ts.read(path).notes
    assert any("outside the area of use of EPSG:32616" in one for one in notes)
