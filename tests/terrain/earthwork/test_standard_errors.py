"""Standard errors of volumes against closed forms, derivatives and draws of errors; refusals."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.terrain.earthwork import variances

NAMES = ("cut", "fill", "net")
UTM = np.array([752_640.0, 4_024_180.0, 320.0])


def lattice(n, *, step=2.0, origin=(0.0, 0.0, 0.0), height=None):
    x, y = (a.ravel() * step for a in np.meshgrid(np.arange(n), np.arange(n)))
    z = np.zeros(len(x)) if height is None else height(x, y)
    return ts.triangulate(np.column_stack([x, y, z]) + origin)


def rough(n, seed, *, size=100.0, origin=(0.0, 0.0, 0.0), relief=1.0):
    rng = np.random.default_rng(seed)
    xy = rng.random((n, 2)) * size
    z = np.sin(xy[:, 0] / 9) + relief * rng.random(n)
    return ts.triangulate(np.column_stack([xy, z]) + origin)


def lifted(tin, heights):
    points = tin.points + np.column_stack([np.zeros((len(heights), 2)), heights])
    return ts.TIN.from_triangles(points, tin.triangles, crs=tin.crs)


def derivatives(measure, tin, step=1e-3):
    """Return how cut, fill and net change with the elevation of each vertex, (n, 3)."""
    rows = []
    for vertex in range(len(tin.points)):
        both = []
        for sign in (1, -1):
            heights = np.zeros(len(tin.points))
            heights[vertex] = sign * step
            table = measure(lifted(tin, heights))
            both.append([float(table[name][0]) for name in NAMES])
        rows.append((np.array(both[0]) - both[1]) / (2 * step))
    return np.array(rows)


def errors_of(table, row=0):
    return np.array([table[f"{name}_error"][row] for name in NAMES])


# ---------------------------------------------------------------- closed forms


@pytest.mark.parametrize("origin", [np.zeros(3), UTM])
def test_two_triangles_above_a_level(origin):
    """A third of each area: corners of both triangles weigh twice as much as the others."""
    tin = ts.triangulate(np.array([[0, 0, 5], [6, 0, 5], [6, 4, 5], [0, 4, 5.0]]) + origin)
    table = ts.volume(tin, base=4.0 + origin[2], standard_error=0.03)
    expected = 0.03 * np.sqrt(4**2 + 4**2 + 8**2 + 8**2)
    assert errors_of(table) == pytest.approx([expected, 0.0, expected], rel=1e-9)


def test_a_shift_moves_the_whole_area():
    tin = lattice(5)
    model = ts.ErrorModel(0.0, systematic=0.05)
    table = ts.volume(tin, base=-1.0, standard_error=model)
    assert errors_of(table) == pytest.approx([0.05 * 64, 0.0, 0.05 * 64], rel=1e-12)


def test_errors_of_both_surfaces_add_up_in_squares():
    tin, other = lattice(5), lattice(9, step=1.0, height=lambda x, y: 1.0 + 0 * x)
    first = ts.volume(tin, other, standard_error=0.02, other_standard_error=0.0)
    second = ts.volume(tin, other, standard_error=0.0, other_standard_error=0.03)
    both = ts.volume(tin, other, standard_error=0.02, other_standard_error=0.03)
    assert errors_of(both)[2] == pytest.approx(np.hypot(errors_of(first), errors_of(second))[2])


@pytest.mark.parametrize("word", ["exponential", "spherical", "gaussian"])
def test_a_range_much_larger_than_the_site_is_a_shift(word):
    model = ts.ErrorModel(0.02, correlation_range=1e7, correlation=word)
    table = ts.volume(lattice(6), base=-1.0, standard_error=model)
    assert errors_of(table)[2] == pytest.approx(0.02 * 100, rel=1e-5)


@pytest.mark.parametrize("word", ["exponential", "spherical", "gaussian"])
def test_a_range_below_the_spacing_is_independent(word):
    model = ts.ErrorModel(0.02, correlation_range=0.05, correlation=word)
    table = ts.volume(lattice(6), base=-1.0, standard_error=model)
    independent = ts.volume(lattice(6), base=-1.0, standard_error=0.02)
    assert errors_of(table) == pytest.approx(errors_of(independent), rel=1e-12)


def test_a_nugget_is_independent():
    tin = rough(60, 3)
    nugget = ts.ErrorModel(0.02, correlation_range=30.0, nugget=1.0)
    table = ts.volume(tin, base=-5.0, standard_error=nugget)
    independent = ts.volume(tin, base=-5.0, standard_error=0.02)
    assert errors_of(table) == pytest.approx(errors_of(independent), rel=1e-12)


# ---------------------------------------------------------------- derivatives


@pytest.mark.parametrize("origin", [np.zeros(3), UTM])
def test_errors_are_those_of_the_derivatives(origin):
    tin, other = rough(40, 1, origin=origin), rough(30, 2, origin=origin)
    table = ts.volume(tin, other, standard_error=0.04, other_standard_error=0.03)
    first = derivatives(lambda one: ts.volume(one, other), tin)
    second = derivatives(lambda one: ts.volume(tin, one), other)
    expected = np.sqrt(0.04**2 * (first**2).sum(axis=0) + 0.03**2 * (second**2).sum(axis=0))
    assert errors_of(table) == pytest.approx(expected, rel=2e-4)
    assert errors_of(table)[2] == pytest.approx(expected[2], rel=1e-6)


def test_a_column_of_the_vertices():
    rng = np.random.default_rng(4)
    points = np.column_stack([rng.random((50, 2)) * 50, rng.random(50)])
    sigma = 0.01 + 0.1 * rng.random(50)
    tin = ts.triangulate(ts.Survey(points=points, attributes={"sz": sigma}))
    table = ts.volume(tin, base=0.5, standard_error="sz")
    found = derivatives(lambda one: ts.volume(one, base=0.5), tin)
    expected = np.sqrt(((found * tin.attributes["sz"][:, None]) ** 2).sum(axis=0))
    assert errors_of(table) == pytest.approx(expected, rel=2e-4)


def test_regions_have_errors_of_their_own():
    tin, other = rough(40, 5), rough(30, 6)
    regions = {
        "west": [[0, 0], [50, 0], [50, 100], [0, 100]],
        "hole": [[20, 20], [90, 20], [70, 80]],
    }
    table = ts.volume(tin, other, regions=regions, standard_error=0.04)
    for row, ring in enumerate(regions.values()):
        found = derivatives(lambda one, ring=ring: ts.volume(one, other, regions=[ring]), tin)
        expected = 0.04 * np.sqrt((found**2).sum(axis=0))
        assert errors_of(table, row) == pytest.approx(expected, rel=5e-4)


def test_feet_above_metres():
    """Elevations in feet: errors too; volumes are in metres cubed."""
    points = [[0, 0, 50], [6, 0, 50], [6, 4, 50], [0, 4, 50]]
    feet = ts.triangulate(points, crs="EPSG:32616", elevation_unit="ft")
    table = ts.volume(feet, base=40.0, standard_error=0.1)
    assert errors_of(table)[0] == pytest.approx(0.1 * 0.3048 * np.sqrt(160), rel=1e-9)
    metres = ts.triangulate(np.array(points) * (1, 1, 0.2), crs="EPSG:32616", elevation_unit="m")
    mixed = ts.volume(metres, feet, standard_error=0.03, other_standard_error=0.1)
    expected = np.hypot(0.03, 0.1 * 0.3048) * np.sqrt(160)
    assert errors_of(mixed)[2] == pytest.approx(expected, rel=1e-9)


# ---------------------------------------------------------------- draws


@pytest.mark.slow
def test_draws_of_independent_errors_scatter_so():
    """The volume itself, drawn again and again: its scatter is the standard error."""
    tin, other = rough(60, 7, relief=0.3), rough(50, 8, relief=0.3)
    table = ts.volume(tin, other, standard_error=0.02, other_standard_error=0.03)
    rng = np.random.default_rng(9)
    drawn = []
    for _ in range(2000):
        one = lifted(tin, 0.02 * rng.standard_normal(len(tin.points)))
        two = lifted(other, 0.03 * rng.standard_normal(len(other.points)))
        found = ts.volume(one, two, threads=1)
        drawn.append([float(found[name][0]) for name in NAMES])
    scatter = np.std(drawn, axis=0)
    # Of 2,000 draws the standard deviation is good to 1.6 %: four times that.
    assert errors_of(table) == pytest.approx(scatter, rel=0.065)


@pytest.mark.slow
@pytest.mark.parametrize("word", ["exponential", "spherical", "gaussian"])
def test_draws_of_correlated_errors_scatter_so(word):
    tin = rough(80, 10)
    model = ts.ErrorModel(
        0.05, systematic=0.01, correlation_range=40.0, correlation=word, nugget=0.2
    )
    table = ts.volume(tin, base=0.2, standard_error=model)
    away = np.hypot(*(tin.points[:, None, :2] - tin.points[None, :, :2]).transpose(2, 0, 1))
    share = away / 40.0
    rho = {
        "exponential": np.exp(-3 * share),
        "gaussian": np.exp(-3 * share**2),
        "spherical": np.where(share < 1, 1 - 1.5 * share + 0.5 * share**3, 0.0),
    }[word]
    covariance = 0.05**2 * (0.8 * rho + 0.2 * np.eye(len(rho))) + 0.01**2
    found = derivatives(lambda one: ts.volume(one, base=0.2), tin)
    expected = np.sqrt(np.einsum("ik,ij,jk->k", found, covariance, found))
    assert errors_of(table) == pytest.approx(expected, rel=1e-3)
    rng = np.random.default_rng(11)
    root = np.linalg.cholesky(covariance + 1e-12 * np.eye(len(rho)))
    heights = rng.standard_normal((4000, len(rho))) @ root.T
    linear = (heights @ found).std(axis=0)
    assert errors_of(table) == pytest.approx(linear, rel=0.045)
    real = [ts.volume(lifted(tin, one), base=0.2)["net"][0] for one in heights[:2000]]
    assert errors_of(table)[2] == pytest.approx(np.std(real), rel=0.065)


# ---------------------------------------------------------------- many pairs


@pytest.mark.parametrize("word", ["exponential", "spherical", "gaussian"])
def test_pairs_in_cells_are_all_pairs(word):
    rng = np.random.default_rng(12)
    xy, loads = rng.random((700, 2)) * (300, 40) + UTM[:2], rng.random((700, 3))
    model = ts.ErrorModel(1.0, correlation_range=9.0, correlation=word)
    away = np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1))
    rho = np.where(away < model.reach, model.correlate(away), 0.0)
    expected = np.einsum("ik,ij,jk->k", loads, rho, loads)
    assert variances.measure_variances(xy, loads, model) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("word", ["exponential", "spherical", "gaussian"])
@pytest.mark.parametrize("reach", [6.0, 40.0, 700.0])
def test_a_lattice_stands_for_many_pairs(word, reach, monkeypatch):
    rng = np.random.default_rng(13)
    xy, loads = rng.random((2500, 2)) * (300, 140) + UTM[:2], rng.random((2500, 2))
    model = ts.ErrorModel(1.0, correlation_range=reach, correlation=word)
    one_by_one = variances.measure_variances(xy, loads, model)
    monkeypatch.setattr(variances, "_FEW_PAIRS", 0)
    monkeypatch.setattr(variances, "_NODES_A_PAIR", 0.0)
    assert variances.measure_variances(xy, loads, model) == pytest.approx(one_by_one, rel=0.01)


def test_parts_do_not_matter(monkeypatch):
    tin, other = rough(300, 14), rough(250, 15)
    regions = [[[0, 0], [80, 0], [50, 100]], [[20, 20], [90, 20], [70, 80]]]
    model = ts.ErrorModel(0.05, correlation_range=20.0)
    whole = ts.volume(tin, other, regions=regions, standard_error=model, level_of_detection=0.4)
    monkeypatch.setattr("tinsmith.terrain.earthwork.cells._CHUNK", 17)
    monkeypatch.setattr(variances, "_PAIRS_AT_A_TIME", 50)
    parts = ts.volume(tin, other, regions=regions, standard_error=model, level_of_detection=0.4)
    for name in whole.columns:
        if name != "region":
            assert parts[name] == pytest.approx(whole[name], rel=1e-11), name


# ---------------------------------------------------------------- copies, notes


def test_a_design_that_is_the_ground_beyond_the_pad_has_its_errors():
    """A design copies the ground outside: there the difference has no error at all."""
    ground = lattice(31)
    ring = [[20, 20], [40, 20], [40, 40], [20, 40]]
    design = ts.grade(ground, ring, 2.0, cut_slope=2, fill_slope=2)
    table = ts.volume(ground, design, standard_error=0.05)
    assert table["net_error"][0] == pytest.approx(table["fill_error"][0], rel=1e-9)
    assert any("copy" in note for note in table.notes)
    assert any("taken as exact" in note for note in table.notes)


def test_two_surveys_that_agree_have_errors():
    flat = lattice(3)
    table = ts.volume(flat, flat, standard_error=0.05, other_standard_error=0.05)
    assert table["net"][0] == 0.0
    assert table["net_error"][0] == pytest.approx(
        ts.volume(flat, base=1.0, standard_error=0.05)["net_error"][0] * np.sqrt(2)
    )
    assert table["cut_error"][0] == 0.0


# ---------------------------------------------------------------- refusals


@pytest.mark.parametrize("given", [-0.1, np.nan, np.inf, True, [0.1, 0.2]])
def test_what_is_no_standard_error_is_refused(given):
    with pytest.raises(ts.OptionError, match="number >= 0 in the unit of elevations"):
        ts.volume(lattice(3), base=1.0, standard_error=given)


@pytest.mark.parametrize(
    "given",
    [
        {"standard_error": -1.0},
        {"standard_error": 1.0, "systematic": -1.0},
        {"standard_error": 1.0, "correlation_range": -1.0},
        {"standard_error": 1.0, "nugget": 1.5},
        {"standard_error": 1.0, "correlation": "cubic"},
    ],
)
def test_what_is_no_error_model_is_refused(given):
    with pytest.raises(ts.OptionError):
        ts.ErrorModel(**given)


def test_a_missing_column_is_named():
    tin = ts.triangulate(
        ts.Survey(points=lattice(3).points, attributes={"sigma_z": np.ones(9), "code": ["a"] * 9})
    )
    with pytest.raises(ts.OptionError, match=r"'sigmaz': it must be one of .*sigma_z"):
        ts.volume(tin, base=1.0, standard_error="sigmaz")
    with pytest.raises(ts.OptionError, match="a column of numbers"):
        ts.volume(tin, base=1.0, standard_error="code")


def test_a_column_must_have_a_value_for_every_vertex():
    sigma = np.ones(9)
    sigma[4] = np.nan
    tin = ts.triangulate(ts.Survey(points=lattice(3).points, attributes={"sz": sigma}))
    with pytest.raises(ts.OptionError, match="none for 1 vertex, such as 2 2"):
        ts.volume(tin, base=1.0, standard_error="sz")
    negative = ts.triangulate(ts.Survey(points=lattice(3).points, attributes={"sz": -np.ones(9)}))
    with pytest.raises(ts.OptionError, match="number >= 0"):
        ts.volume(negative, base=1.0, standard_error="sz")


def test_a_level_has_no_errors():
    with pytest.raises(ts.OptionError, match="which are exact"):
        ts.volume(lattice(3), base=1.0, other_standard_error=0.1)
