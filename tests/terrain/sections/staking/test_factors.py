"""Combined factors: closed forms, geodesics, the way to the ground and back, what CRS it has."""

import math
import warnings

import numpy as np
import pyproj
import pytest

import tinsmith as ts

CONFORMAL = {
    "EPSG:2274": (1_750_000.0, 650_000.0),
    "EPSG:2180": (500_000.0, 500_000.0),
    "EPSG:2048": (20_000.0, 3_700_000.0),
    "EPSG:2056": (2_650_000.0, 1_200_000.0),
    "EPSG:5514": (-600_000.0, -1_100_000.0),
    "EPSG:27700": (400_000.0, 300_000.0),
    "EPSG:31467": (3_580_000.0, 5_500_000.0),
    "EPSG:32616": (750_000.0, 4_020_000.0),
    "EPSG:32616+5703": (750_000.0, 4_020_000.0),
}


@pytest.mark.parametrize("crs", CONFORMAL)
@pytest.mark.parametrize("angle", [0.0, 1.0, 2.0])
def test_the_scale_is_that_of_the_grid_over_a_geodesic(crs, angle):
    base = np.array(CONFORMAL[crs])
    factor = ts.combined_factor(crs, point=base, elevation=0.0, undulation=0.0)
    flat = ts.CRS(crs).horizontal.to_pyproj()
    step = 300.0 * np.array([math.cos(angle), math.sin(angle)])
    turn = pyproj.Transformer.from_crs(flat, flat.geodetic_crs, always_xy=True)
    longitude, latitude = turn.transform(*np.array([base - step, base + step]).T)
    *_, length = flat.get_geod().inv(longitude[0], latitude[0], longitude[1], latitude[1])
    along = 600.0 * flat.axis_info[0].unit_conversion_factor
    assert factor.grid_scale == pytest.approx(along / length, abs=3e-9)
    assert factor.elevation_factor == 1.0


def test_the_scale_of_transverse_mercator_is_its_closed_form():
    """Snyder (1987), equation 8-11, to the fourth power of the easting: k0 (1 + x²/2R² + ...)."""
    crs = ts.CRS("EPSG:32616")
    east, north = 650_000.0, 4_020_000.0
    factor = ts.combined_factor(crs, point=(east, north), elevation=0.0, undulation=0.0)
    major, flattening, k0 = 6_378_137.0, 1 / 298.257223563, 0.9996
    e2 = flattening * (2 - flattening)
    foot = pyproj.Transformer.from_crs(crs.to_pyproj(), "EPSG:4326", always_xy=True)
    latitude = math.radians(foot.transform(500_000.0, north)[1])
    bulge = 1 - e2 * math.sin(latitude) ** 2
    across = (east - 500_000.0) ** 2 * bulge**2 / (k0**2 * major**2 * (1 - e2))
    assert factor.grid_scale == pytest.approx(k0 * (1 + across / 2 + across**2 / 24), abs=2e-9)


def test_the_scale_of_lambert_is_one_on_its_standard_parallels():
    crs = ts.CRS("EPSG:2274")  # 35°15' and 36°25'
    turn = pyproj.Transformer.from_crs(
        crs.to_pyproj().geodetic_crs, crs.to_pyproj(), always_xy=True
    )
    for latitude in (35.25, 36.0 + 25.0 / 60.0):
        point = turn.transform(-86.0, latitude)
        found = ts.combined_factor(crs, point=point, elevation=0.0, undulation=0.0)
        assert found.grid_scale == pytest.approx(1.0, abs=1e-10)


def test_the_elevation_factor_is_that_of_the_mean_radius_in_any_unit():
    how = {"point": CONFORMAL["EPSG:2274"], "undulation": -30.0, "elevation_unit": "m"}
    factor = ts.combined_factor("EPSG:2274", elevation=1030.0, **how)
    radius = (1.0 / (1.0 / factor.elevation_factor - 1.0)) * 1000.0
    assert 6_356_000 < radius < 6_385_000
    feet = {"point": how["point"], "undulation": -30.0 / 0.3048, "elevation_unit": "ft"}
    other = ts.combined_factor("EPSG:2274", elevation=1030.0 / 0.3048, **feet)
    assert other.combined == pytest.approx(factor.combined, rel=1e-14)
    assert factor.combined == factor.grid_scale * factor.elevation_factor
    assert factor.notes == (
        "The elevation factor is that of a mean elevation of 1030 m and an undulation of -30 m.",
    )


def test_a_surface_tells_its_middle_its_mean_elevation_and_its_unit():
    points = [
        [2e6, 5e5, 300],
        [2e6 + 100, 5e5, 300],
        [2e6 + 100, 5e5 + 60, 330],
        [2e6, 5e5 + 60, 330],
    ]
    tin = ts.triangulate(points, crs="EPSG:2274", elevation_unit="ft")
    found = ts.combined_factor(tin)
    asked = ts.combined_factor(
        "EPSG:2274", point=(2e6 + 50, 5e5 + 30), elevation=315.0, elevation_unit="ft"
    )
    assert found.base == asked.base
    assert found.combined == pytest.approx(asked.combined, rel=1e-15)
    assert "undulation is not known" in found.notes[0]


@pytest.mark.parametrize(
    ("crs", "word"),
    [
        ("EPSG:3857", "not conformal"),
        ("EPSG:5070", "not conformal"),
        ("EPSG:4326", "angles"),
    ],
)
def test_a_scale_that_depends_on_the_direction_is_refused(crs, word):
    with pytest.raises(ts.CrsError, match=word):
        ts.combined_factor(crs, point=(1e6, 2e6), elevation=0.0)


@pytest.mark.parametrize(
    ("how", "word"),
    [
        ({"elevation": 1.0}, "point"),
        ({"point": (5e5, 4e6)}, "elevation"),
        ({"point": (5e5, 4e6), "elevation": 1e9}, "height"),
        ({"point": (5e5, 4e6, 1.0), "elevation": 1.0}, "point"),
    ],
)
def test_what_is_missing_is_named(how, word):
    with pytest.raises(ts.OptionError, match=word):
        ts.combined_factor("EPSG:32616", **how)


def test_factors_that_are_none_are_refused():
    for value in (0.0, -1.0, 9998.0, math.nan, None):
        with pytest.raises(ts.OptionError, match="combined"):
            ts.CombinedFactor(value, base=(0, 0))
    with pytest.raises(ts.OptionError, match="product"):
        ts.CombinedFactor(0.9999, base=(0, 0), grid_scale=0.9999, elevation_factor=0.9999)


# ---------------------------------------------------------------- there and back


@pytest.fixture
def site():
    base = np.array(CONFORMAL["EPSG:32616"])
    rng = np.random.default_rng(1)
    points = np.column_stack([base + rng.random((60, 2)) * 400, 300 + rng.random(60)])
    breakline = np.column_stack([base + np.array([[50.0, 50], [350, 300]]), [300.5, 300.6]])
    return ts.triangulate(points, breaklines=[breakline], crs="EPSG:32616", elevation_unit="m")


@pytest.mark.parametrize("crs", CONFORMAL)
def test_proj_finds_the_grid_from_the_crs_of_the_ground(crs):
    base = np.array(CONFORMAL[crs])
    factor = ts.combined_factor(crs, point=base, elevation=400.0)
    grid = base + np.random.default_rng(0).random((20, 2)) * 5000
    ground = factor.to_ground(grid)
    apart = np.linalg.norm(ground[1:] - ground[0], axis=1)
    assert apart * factor.combined == pytest.approx(np.linalg.norm(grid[1:] - grid[0], axis=1))
    made = factor.ground_crs
    assert not made.is_same(crs)
    assert made.to_epsg() is None
    assert made.vertical_unit == ts.CRS(crs).vertical_unit
    assert ts.CRS(made.to_wkt()).is_same(made)
    back = pyproj.Transformer.from_crs(
        made.horizontal.to_pyproj(), ts.CRS(crs).horizontal.to_pyproj(), always_xy=True
    )
    assert np.column_stack(back.transform(*ground.T)) == pytest.approx(grid, abs=1e-6)
    assert factor.to_grid(ground) == pytest.approx(grid, abs=1e-7)


def test_a_surface_on_the_ground_never_claims_the_crs_of_the_grid(site):
    factor = ts.combined_factor(site)
    ground = factor.to_ground(site)
    assert ts.check(ground).ok
    assert ground.crs.is_same(factor.ground_crs)
    assert not ground.crs.is_same(site.crs)
    assert ground.elevation_unit == site.elevation_unit
    assert "on the ground" in ground.report.notes[-2]
    assert len(ground.lines) == len(site.lines)
    back = factor.to_grid(ground)
    assert back.crs == site.crs
    assert back.points == pytest.approx(site.points, abs=1e-7)
    area = ts.volume(site, base=200.0)["cut"][0]
    assert ts.volume(ground, base=200.0)["cut"][0] == pytest.approx(area / factor.combined**2)
    again = ts.reproject(ground, "EPSG:32616")
    assert again.points == pytest.approx(site.points, abs=1e-6)


def test_no_format_turns_the_ground_into_the_grid(site, tmp_path):
    """A format that cannot name the CRS says so, or refuses; read again it is no grid."""
    factor = ts.combined_factor(site)
    ground = factor.to_ground(site)
    kept = []
    for one in ts.known_formats():
        if "TIN" not in one.writes or one.name in ("3dtiles", "quantized-mesh"):
            continue
        path = tmp_path / f"{one.name}{''.join(one.suffixes[:1])}"
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ts.LossWarning)
            try:
                ts.write(ground, path, format=one.name)
            except ts.TinsmithError:
                continue
            if one.read is None or "TIN" not in one.reads:
                continue
            try:
                again = ts.read(path, format=one.name)
            except ts.TinsmithError:
                continue
        if again.crs is not None and again.crs.is_same(ground.crs):
            kept.append(one.name)
        else:
            assert again.crs is None, one.name
    assert len(kept) >= 2


def test_mixed_systems_are_refused(site):
    factor = ts.combined_factor(site)
    ground = factor.to_ground(site)
    with pytest.raises(ts.CrsError, match="coordinates on the grid"):
        factor.to_ground(ground)
    with pytest.raises(ts.CrsError, match="coordinates on the ground"):
        factor.to_grid(site)
    with pytest.raises(ts.CrsError, match="not known"):
        factor.to_ground(ts.triangulate(site.points))
    assert factor.to_grid(ts.triangulate(ground.points)).crs == site.crs
    with pytest.raises(ts.OptionError, match="places"):
        factor.to_ground("here")


def test_an_alignment_is_scaled_with_its_stations():
    turns = [[0, 0], [300, 20], [400, 300], [800, 250]]
    rise = ts.VerticalAlignment(
        [
            ts.VerticalPoint(100.0, 5.0),
            ts.VerticalPoint(300.0, 9.0, "parabola", 60.0, 80.0),
            ts.VerticalPoint(600.0, 2.0),
        ]
    )
    jump = ts.StationEquation(250.0, ahead=1000.0)
    how = {"start": 100.0, "verticals": [rise], "equations": [jump]}
    road = ts.Alignment.from_points(turns, radii=[90, 60], transitions=[40, 30], **how)
    factor = ts.CombinedFactor(0.98, base=(100.0, 50.0))
    ground = factor.to_ground(road)
    at = np.linspace(road.start, road.end, 50)
    there = np.clip(road.start + (at - road.start) / 0.98, None, ground.end)
    expected = factor.to_ground(road.points_at(at))
    assert ground.points_at(there) == pytest.approx(expected, abs=1e-8)
    inside = (at > 101) & (at < 599)
    heights = ground.elevations_at(there[inside])
    assert heights == pytest.approx(road.elevations_at(at[inside]), abs=1e-10)
    assert ground.length == pytest.approx(road.length / 0.98, rel=1e-12)
    back = factor.to_grid(ground)
    assert back.points_at(at[:-1]) == pytest.approx(road.points_at(at[:-1]), abs=1e-8)
    arcs = [
        ts.VerticalPoint(100, 5),
        ts.VerticalPoint(300, 9, "arc", radius=900.0),
        ts.VerticalPoint(600, 2),
    ]
    bent = ts.Alignment.from_points(turns, start=100.0, verticals=[ts.VerticalAlignment(arcs)])
    with pytest.raises(ts.OptionError, match="without arcs"):
        factor.to_ground(bent)


def test_features_keep_their_columns():
    lines = ts.Features.of_lines([[0, 0, 1], [10, 0, 2]], [0, 2], columns={"name": ["a"]})
    moved = ts.CombinedFactor(0.5, base=(0, 0)).to_ground(lines)
    assert moved.coordinates.tolist() == [[0, 0, 1], [20, 0, 2]]
    assert moved.columns["name"].tolist() == ["a"]
