"""Lifting a TIN: the origin, the precision that it saves, and what the mesh carries."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from tinsmith import TIN, MissingExtraError, TinsmithError, triangulate
from tinsmith.terrain import OptionError, aspect, lift, slope
from tinsmith.terrain.drawing.models import choose_origin

pytest.importorskip("pyvista")


def survey(n=1000, seed=1, *, extent=250.0, crs="EPSG:32616"):
    random = np.random.default_rng(seed)
    corner = np.array([742_318.25, 4_030_117.5, 1_834.0])
    spread = np.array([extent, extent * 0.7, 40.0])
    return triangulate(corner + spread * random.uniform(0, 1, (n, 3)), crs=crs)


def single_precision_error(mesh, tin, origin):
    """Largest distance along an axis between float32 points put back and the truth."""
    restored = mesh.points.astype(np.float32).astype(np.float64) + origin
    return np.abs(restored - tin.points).max()


def test_points_keep_their_place_in_single_precision():
    tin = survey()
    mesh = lift(tin)
    assert single_precision_error(mesh, tin, mesh.field_data["origin"]) < 1e-4
    without_origin = lift(tin, origin=(0, 0, 0))
    assert single_precision_error(without_origin, tin, 0.0) > 0.1


def test_points_plus_origin_are_the_tin_points():
    tin = survey()
    mesh = lift(tin)
    np.testing.assert_allclose(mesh.points + mesh.field_data["origin"], tin.points, rtol=1e-15)


@pytest.mark.parametrize("extent", [0.02, 250.0, 80_000.0])
def test_the_default_origin_is_near_and_round(extent):
    tin = survey(extent=extent)
    origin = choose_origin(tin)
    shifted = np.abs(tin.points - origin).max(axis=0)
    assert (shifted <= np.maximum(np.ptp(tin.points, axis=0), extent)).all()
    step = 10.0 ** np.floor(np.log10(np.ptp(tin.points[:, 0])))
    np.testing.assert_allclose(origin[:2] / step, np.round(origin[:2] / step), rtol=1e-12)


@pytest.mark.parametrize("turned", [False, True])
def test_the_default_origin_of_a_strip_is_rounded_by_its_length(turned):
    strip = [[10.3, 17.0, 3.4], [10.7, 817.0, 3.6], [11.4, 300.0, 2.5]]
    points = [[y, x, z] for x, y, z in strip] if turned else strip
    assert choose_origin(triangulate(points)).tolist() == (
        [400.0, 0.0, 3.0] if turned else [0.0, 400.0, 3.0]
    )


def test_the_default_origin_of_level_ground_is_its_elevation_rounded():
    tin = triangulate([[0, 0, 7.4], [30, 0, 7.4], [0, 30, 7.4]])
    assert choose_origin(tin).tolist() == [20.0, 20.0, 7.0]


def test_a_given_origin_and_exaggeration_are_used_and_recorded():
    tin = survey()
    mesh = lift(tin, origin=(742_000, 4_030_000, 1_800), exaggeration=2.5)
    expected = (tin.points - (742_000, 4_030_000, 1_800)) * (1, 1, 2.5)
    np.testing.assert_array_equal(mesh.points, expected)
    assert mesh.field_data["origin"].tolist() == [742_000, 4_030_000, 1_800]
    assert mesh.field_data["exaggeration"].tolist() == [2.5]


@pytest.mark.parametrize(("crs", "recorded"), [("EPSG:32616", "EPSG:32616"), (None, "")])
def test_the_crs_is_recorded(crs, recorded):
    assert list(lift(survey(crs=crs)).field_data["crs"]) == [recorded]


def test_every_vertex_and_triangle_is_there_in_order():
    tin = survey()
    mesh = lift(tin)
    assert (mesh.n_points, mesh.n_cells) == (len(tin.points), len(tin.triangles))
    np.testing.assert_array_equal(mesh.regular_faces, tin.triangles)


def test_the_mesh_carries_true_elevation_slope_and_aspect():
    tin = survey()
    mesh = lift(tin, exaggeration=3)
    np.testing.assert_array_equal(mesh.point_data["elevation"], tin.points[:, 2])
    np.testing.assert_array_equal(mesh.cell_data["slope"], slope(tin))
    np.testing.assert_array_equal(mesh.cell_data["aspect"], aspect(tin))


def test_vtk_finds_the_area_that_the_tin_states():
    tin = survey()
    assert lift(tin).area == pytest.approx(tin.surface_area, rel=1e-9)


def test_the_mesh_is_a_copy():
    tin = survey(n=3)
    mesh = lift(tin, origin=(0, 0, 0))
    before = tin.points.copy()
    mesh.points[:] = 0.0
    mesh.point_data["elevation"][:] = 0.0
    np.testing.assert_array_equal(tin.points, before)


@pytest.mark.parametrize("exaggeration", [0, -1, float("nan"), float("inf")])
def test_an_exaggeration_must_be_finite_and_above_zero(exaggeration):
    with pytest.raises(OptionError, match=r"exaggeration .* finite number > 0") as caught:
        lift(survey(n=3), exaggeration=exaggeration)
    assert caught.value.option == "exaggeration"
    assert isinstance(caught.value, TinsmithError)
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize("origin", [(1, 2), (1, 2, float("nan")), 5.0])
def test_an_origin_must_be_three_finite_numbers(origin):
    with pytest.raises(OptionError, match="three finite numbers"):
        lift(survey(n=3), origin=origin)


def test_without_pyvista_the_extra_is_named(monkeypatch):
    tin = TIN.from_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(MissingExtraError, match=r"pip install pyvista\.$") as caught:
        lift(tin)
    assert caught.value.extra == ""


@pytest.mark.parametrize("function", [slope, aspect, lift])
@pytest.mark.parametrize("given", [None, {"x": "a"}, np.zeros((3, 3)), TIN])
def test_what_is_no_tin_is_refused(function, given):
    with pytest.raises(TinsmithError, match=r"^Invalid TIN .*one made by triangulate is needed"):
        function(given)


@pytest.mark.parametrize("origin", [b"mean", {}, 10**400, [[0.0, 0.0, 0.0]]])
def test_an_origin_that_is_no_place_is_refused(origin):
    tin = triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    with pytest.raises(OptionError, match=r"^Invalid origin .*three finite numbers"):
        lift(tin, origin=origin)


@pytest.mark.parametrize("factor", [object(), "2", None, 10**400, True])
def test_an_exaggeration_that_is_no_number_is_refused(factor):
    tin = triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    with pytest.raises(OptionError, match=r"^Invalid exaggeration .*a finite number > 0"):
        lift(tin, exaggeration=factor)
