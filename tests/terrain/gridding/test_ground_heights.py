"""Heights above ground."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.base.errors import CrsError, OptionError, PointsError

GROUND = [[0, 0, 10], [10, 0, 20], [0, 10, 30]]


def ground(**reference):
    return ts.triangulate(GROUND).replace(**reference)


def test_heights_are_elevations_less_those_of_the_ground():
    cloud = np.array([[1, 1, 15], [2, 3, 8], [9, 9, 50], [0, 0, 10]], float)
    above = ts.height_above(ground(), cloud)
    np.testing.assert_allclose(above["ground"], [13, 18, np.nan, 10])
    np.testing.assert_allclose(above["height_above_ground"], [2, -10, np.nan, 0])
    np.testing.assert_array_equal(
        np.column_stack([above["easting"], above["northing"], above["elevation"]]), cloud
    )


def test_what_lies_outside_is_told():
    cloud = np.full((2000, 3), 99.0)
    cloud[::2] = [1, 1, 20]
    assumed, note = ts.height_above(ground(), cloud).notes
    assert note == (
        "1,000 of 2,000 points lie outside the surface (rows 1, 3, 5, 7, 9, ...): they have no "
        "height above ground."
    )
    assert ts.height_above(ground(), cloud, extrapolate="nearest").notes == (assumed,)


def test_units_are_converted_and_said():
    survey = ts.Survey(points=[[1, 1, 100.0]], crs="EPSG:32616", elevation_unit="ft")
    above = ts.height_above(ground(crs="EPSG:32616", elevation_unit="m"), survey)
    assert above["elevation"] == pytest.approx(30.48)
    assert above["height_above_ground"] == pytest.approx(17.48)
    assert "converted from foot to metre" in above.notes[0]
    assert above.units["height_above_ground"].name == "metre"
    assert survey.points[0, 2] == 100.0


def test_an_unknown_unit_is_assumed_loudly():
    survey = ts.Survey(points=[[1, 1, 100.0]], crs="EPSG:32616")
    (note,) = ts.height_above(ground(crs="EPSG:32616", elevation_unit="m"), survey).notes
    assert note == "The unit of the elevations of the points is not known: taken to be the metre."


def test_another_crs_is_refused():
    survey = ts.Survey(points=[[1, 1, 100.0]], crs="EPSG:32617")
    with pytest.raises(CrsError, match=r"EPSG:32616 and the points in EPSG:32617"):
        ts.height_above(ground(crs="EPSG:32616"), survey)


def test_other_methods_and_wrong_ones():
    assert ts.height_above(ground(), [[1, 1, 15]], method="natural")["ground"] == pytest.approx(13)
    with pytest.raises(OptionError, match="Invalid method"):
        ts.height_above(ground(), [[1, 1, 15]], method="best")
    with pytest.raises(PointsError, match="not finite"):
        ts.height_above(ground(), [[1, np.nan, 15]])
    with pytest.raises(PointsError, match="shape"):
        ts.height_above(ground(), [[1, 2]])
