"""One rule of CRS and units for every product."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.base.crs import CRS, Unit
from tinsmith.base.georeference import agree

SITE = ts.triangulate([[0, 0, 0], [10, 0, 1], [10, 10, 5], [0, 10, 3], [4, 6, 2]])
LINE = [[1, 1], [9, 8]]
FEATURES = ts.Features.of_lines([[1.0, 1], [9, 8]], [0, 2])

PRODUCTS = {
    "contours": lambda tin: ts.contours(tin, interval=1).notes,
    "bands": lambda tin: ts.contour_bands(tin, interval=1).notes,
    "labels": lambda tin: ts.contour_labels(ts.contours(tin, interval=1)).notes,
    "profile": lambda tin: ts.profile(tin, LINE).notes,
    "cross_sections": lambda tin: ts.cross_sections(tin, LINE, interval=5, width=2).notes,
    "section_lines": lambda tin: ts.section_lines(tin, LINE, interval=5, width=2).notes,
    "drape": lambda tin: ts.drape(tin, LINE).notes,
    "slope_classes": lambda tin: ts.slope_classes(tin).notes,
    "aspect_classes": lambda tin: ts.aspect_classes(tin).notes,
    "slope_statistics": lambda tin: ts.slope_statistics(tin).notes,
    "hillshade": lambda tin: ts.hillshade(tin, spacing=1).notes,
    "rasterize": lambda tin: ts.rasterize(tin, spacing=1).notes,
    "volume": lambda tin: ts.volume(tin, base=2).notes,
    "volume between": lambda tin: ts.volume(tin, tin).notes,
    "stage_storage": lambda tin: ts.stage_storage(tin, levels=[2]).notes,
    "difference": lambda tin: ts.difference(tin, tin).notes,
    "zones": lambda tin: ts.difference(tin, tin).zones.notes,
    "height_above": lambda tin: ts.height_above(tin, [[5, 5, 9]]).notes,
}


@pytest.mark.parametrize("product", PRODUCTS)
@pytest.mark.parametrize(
    ("crs", "unit", "told"),
    [
        ("EPSG:32616", "m", ()),
        (
            "EPSG:32616",
            None,
            ("The unit of elevations is not known: taken to be the metre.",),
        ),
        (
            "EPSG:2274",
            None,
            ("The unit of elevations is not known: taken to be the US survey foot.",),
        ),
        (
            None,
            None,
            ("The CRS is not known: lengths are in its own unit, elevations taken as the same.",),
        ),
    ],
)
def test_what_is_not_known_is_told_once_by_every_product(product, crs, unit, told):
    notes = PRODUCTS[product](SITE.replace(crs=crs, elevation_unit=unit))
    assert tuple(note for note in notes if "Slopes are" not in note) == told


AREAS = {
    "bands": lambda tin: (ts.contour_bands(tin, interval=1), "area"),
    "slope classes": lambda tin: (ts.slope_classes(tin), "area"),
    "slope statistics": lambda tin: (ts.slope_statistics(tin), "area"),
    "volume": lambda tin: (ts.volume(tin, base=2), "area"),
    "zones": lambda tin: (ts.difference(tin, tin).zones, "area"),
    "stages": lambda tin: (ts.stage_storage(tin, levels=[9]), "area"),
}


@pytest.mark.parametrize("product", AREAS)
@pytest.mark.parametrize(
    ("crs", "unit"), [("EPSG:2274", "US ft²"), ("EPSG:32616", "m²"), (None, None)]
)
def test_areas_are_in_the_unit_of_the_crs_squared(product, crs, unit):
    found, column = AREAS[product](SITE.replace(crs=crs))
    assert found.units[column] == unit
    assert found.columns[column].sum() == pytest.approx(100.0, rel=1e-12)


PAIRS = {
    "profile": lambda one, other: ts.profile([one, other], LINE),
    "cross_sections": lambda one, other: ts.cross_sections([one, other], LINE, interval=5, width=2),
    "volume": ts.volume,
    "difference": ts.difference,
    "height_above": lambda one, other: ts.height_above(
        one, ts.Survey(points=other.points, crs=other.crs, elevation_unit=other.elevation_unit)
    ),
}


@pytest.mark.parametrize("product", PAIRS)
@pytest.mark.parametrize(
    ("ours", "theirs", "part"),
    [
        ({"crs": "EPSG:32616"}, {}, "not known: give that of both"),
        ({}, {"crs": "EPSG:32616"}, "not known: give that of both"),
        ({"crs": "EPSG:32616"}, {"crs": "EPSG:32617"}, "bring the points of one into the CRS"),
        ({"elevation_unit": "m"}, {}, "never mixed on a guess"),
        (
            {"crs": "EPSG:2274", "elevation_unit": "m"},
            {"crs": "EPSG:2274"},
            "US survey foot is usual in the CRS",
        ),
        ({"crs": "EPSG:2274+6360"}, {"crs": "EPSG:2274+8228"}, "must refer to one vertical CRS"),
    ],
)
def test_surfaces_are_refused_alike_by_every_product(product, ours, theirs, part):
    with pytest.raises(ts.CrsError, match=part):
        PAIRS[product](SITE.replace(**ours), SITE.replace(**theirs))


@pytest.mark.parametrize("product", PAIRS)
def test_known_units_are_converted_and_unknown_ones_told_alike(product):
    metres = SITE.replace(crs="EPSG:32616", elevation_unit="m")
    feet = SITE.replace(crs="EPSG:32616", elevation_unit="ft")
    (note,) = PAIRS[product](metres, feet).notes
    assert note.endswith("were converted from foot to metre.")
    (note,) = PAIRS[product](metres, SITE.replace(crs="EPSG:32616")).notes
    assert note.endswith("is not known: taken to be the metre.")
    (note,) = PAIRS[product](SITE.replace(crs="EPSG:32616"), metres).notes
    assert note.endswith("is not known: taken to be the metre.")
    compound = SITE.replace(crs="EPSG:32616+5703", elevation_unit="m")
    (note,) = PAIRS[product](metres, compound).notes
    assert "vertical CRS" in note


LAID = {
    "profile": ts.profile,
    "cross_sections": lambda tin, line: ts.cross_sections(tin, line, interval=5, width=2),
    "drape": ts.drape,
    "volume": lambda tin, line: ts.volume(tin, base=2, regions=_as_region(line)),
    "stage_storage": lambda tin, line: ts.stage_storage(tin, levels=[2], region=_as_region(line)),
}


def _as_region(line):
    ring = [[1.0, 1], [9, 1], [9, 8], [1, 1]]
    return ts.Features.of_polygons(ring, [0, 4], [0, 1], crs=line.crs)


@pytest.mark.parametrize("product", LAID)
def test_what_is_laid_on_a_surface_is_told_or_refused_alike(product):
    named = SITE.replace(crs="EPSG:32616", elevation_unit="m")
    (note,) = LAID[product](named, FEATURES).notes
    assert note.endswith("is not known: taken to be that of the surface, EPSG:32616.")
    here = ts.Features.of_lines(FEATURES.coordinates, [0, 2], crs="EPSG:32616")
    assert tuple(LAID[product](named, here).notes) == ()
    with pytest.raises(ts.CrsError, match="that of the surface is not known"):
        LAID[product](SITE, here)
    there = ts.Features.of_lines(FEATURES.coordinates, [0, 2], crs="EPSG:32617")
    with pytest.raises(ts.CrsError, match="they must be the same"):
        LAID[product](named, there)


class _Ground:
    """A surface, as far as its reference goes."""

    def __init__(self, crs, unit):
        self.crs, self.elevation_unit = CRS.of(crs), unit


def test_a_unit_whose_length_is_not_known_is_never_taken_for_another():
    odd = Unit("stage unit", "su", None)
    with pytest.raises(ts.CrsError, match="cannot be compared"):
        agree([_Ground("EPSG:32616", Unit.of("m")), _Ground("EPSG:32616", odd)], ["a", "b"])
    found = agree([_Ground("EPSG:32616", odd), _Ground("EPSG:32616", odd)], ["a", "b"])
    assert found.factors == (1.0, 1.0)


def test_factors_lead_to_the_first_known_unit():
    feet, metres = Unit.of("ft"), Unit.of("m")
    found = agree([_Ground(None, feet), _Ground(None, metres)], ["a", "b"])
    assert found.elevation_unit == feet
    np.testing.assert_allclose(found.factors, (1.0, 1 / 0.3048))
    assert "The elevations of b were converted from metre to foot." in found.notes
