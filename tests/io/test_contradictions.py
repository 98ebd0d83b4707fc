"""Coordinates that contradict their CRS are refused by the reader of every format."""

import json

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.io.registry.lookup import known_formats

CRS = "EPSG:32616"
RNG = np.random.default_rng(1)
OFFSETS = np.column_stack([50 * RNG.random((12, 2)), RNG.random(12)])
SITE = OFFSETS + np.array([752700.0, 4024200.0, 320.0])
EXCHANGED = SITE[:, [1, 0, 2]]
DEGREES = OFFSETS * np.array([1e-4, 1e-4, 1.0]) + np.array([-84.5, 36.3, 320.0])

GEOGRAPHIC = ("geojson", "geojsonseq")
"""Formats in longitude and latitude, which a file by hand holds in the other order."""
BY_SUFFIX = {"raster": ".asc", "vector": ".gml"}
"""Families that GDAL reads: a file of one of them by hand."""
NOT_PLACED_BY_CRS = {
    "gsi": "records of an instrument, through io.field_survey.instruments.records",
    "sdr": "records of an instrument, through io.field_survey.instruments.records",
    "jobxml": "records of an instrument, through io.field_survey.instruments.records",
    "dc": "records of an instrument, through io.field_survey.instruments.records",
    "esri-tin": "a folder of binary parts, through make_tin as the other meshes",
    "terrain": "WGS 84 by its definition",
    "quantized-mesh": "WGS 84 by its definition",
    "dxf": "takes the order that lies in the area, with a note",
    "landxml": "takes the order that lies in the area, with a note",
}
WRITTEN = [
    one.name
    for one in known_formats()
    if one.read
    and one.is_built_in
    and one.name not in (*GEOGRAPHIC, *BY_SUFFIX, *NOT_PLACED_BY_CRS)
]


def _write(name, points, folder):
    """Write points of no CRS in a format, as triangles where the format has only such."""
    form = next(one for one in known_formats() if one.name == name and one.read)
    path = folder / f"a{form.suffixes[0]}"
    kind = {"kind": "points"} if "kind" in form.options("write") else {}
    return ts.write(ts.triangulate(points), path, format=name, **kind)


def _write_grid(corner, cell, path):
    head = f"ncols 3\nnrows 3\nxllcorner {corner[0]}\nyllcorner {corner[1]}\ncellsize {cell}\n"
    path.write_text(f"{head}1 2 3\n4 5 6\n7 8 9\n")


def _write_gml(points, path):
    members = "".join(
        f'<gml:featureMember><a fid="a.{i}"><g><gml:Point><gml:coordinates>{x},{y},{z}'
        "</gml:coordinates></gml:Point></g></a></gml:featureMember>"
        for i, (x, y, z) in enumerate(points.tolist())
    )
    path.write_text(
        '<?xml version="1.0"?><gml:FeatureCollection xmlns:gml="http://www.opengis.net/gml">'
        f"{members}</gml:FeatureCollection>"
    )


@pytest.mark.parametrize("name", WRITTEN)
def test_exchanged_axes_are_refused_by_every_reader(tmp_path, name):
    path = _write(name, EXCHANGED, tmp_path)
    with pytest.raises(ts.CrsError, match="inside"):
        ts.read(path, format=name, crs=CRS)
    right = tmp_path / "right"
    right.mkdir()
    found = ts.read(_write(name, SITE, right), format=name, crs=CRS)
    assert np.allclose(np.sort(found.points[:, 0]), np.sort(SITE[:, 0]), atol=0.6)


@pytest.mark.parametrize("name", [one for one in WRITTEN if one != "delimited"])
def test_exchanged_axes_are_taken_where_the_caller_asks(tmp_path, name):
    found = ts.read(_write(name, EXCHANGED, tmp_path), format=name, crs=CRS, check_crs=False)
    notes = found.notes if isinstance(found, ts.Survey) else found.report.notes
    assert any("in the other order" in one for one in notes)


@pytest.mark.parametrize("name", WRITTEN)
def test_degrees_never_become_metres_without_a_word(tmp_path, name):
    path = _write(name, DEGREES, tmp_path)
    try:
        found = ts.read(path, format=name, crs=CRS)
    except ts.TinsmithError:
        return
    notes = found.notes if isinstance(found, ts.Survey) else found.report.notes
    assert any("degrees" in one for one in notes)
    assert (found.points[:, 1] > 4e6).all()


def test_longitude_and_latitude_in_the_other_order_are_refused(tmp_path):
    features = [
        {"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": place}}
        for place in DEGREES[:, [1, 0, 2]].tolist()
    ]
    path = tmp_path / "a.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    with pytest.raises(ts.CrsError, match="in the other order"):
        ts.read(path, crs=CRS)


def test_a_grid_and_gml_with_exchanged_axes_are_refused(tmp_path):
    _write_grid((4024200, 752700), 10, tmp_path / "a.asc")
    _write_gml(EXCHANGED, tmp_path / "a.gml")
    for name in ("a.asc", "a.gml"):
        with pytest.raises(ts.CrsError, match="in the other order"):
            ts.read(tmp_path / name, crs=CRS)


def test_a_grid_of_no_crs_in_degrees_is_placed_by_them(tmp_path):
    _write_grid((-84.5, 36.3), 0.001, tmp_path / "a.asc")
    found = ts.read(tmp_path / "a.asc", crs=CRS)
    assert (found.points[:, 1] > 4e6).all()
    assert any("degrees of WGS 84" in one for one in found.notes)


def test_every_format_that_is_read_is_looked_at():
    known = {one.name for one in known_formats() if one.read and one.is_built_in}
    assert known <= {*WRITTEN, *GEOGRAPHIC, *BY_SUFFIX, *NOT_PLACED_BY_CRS}


@pytest.mark.parametrize("mode", ["relativeToGround", "clampToGround"])
def test_heights_above_the_ground_are_no_elevations(tmp_path, mode):
    places = "".join(
        f"<Placemark><Point><altitudeMode>{mode}</altitudeMode><coordinates>{x},{y},{z}"
        "</coordinates></Point></Placemark>"
        for x, y, z in DEGREES.tolist()
    )
    path = tmp_path / "a.kml"
    path.write_text(
        f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document>{places}</Document></kml>'
    )
    with pytest.raises(ts.ReadError, match=f"altitudeMode '{mode}'"):
        ts.read(path, crs=CRS)
    assert len(ts.read(path, crs=CRS, z_field="geometry")) == len(DEGREES)


def _write_bands(path, *descriptions):
    rasterio = pytest.importorskip("rasterio")
    transform = rasterio.Affine(10, 0, 752700, 0, -10, 4024300)
    with rasterio.open(
        path, "w", driver="GTiff", width=4, height=3, count=len(descriptions), dtype="float32",
        crs=CRS, transform=transform,
    ) as file:  # fmt: skip
        for number, text in enumerate(descriptions, start=1):
            file.write(np.full((3, 4), 100.0 * number + np.arange(4), "float32"), number)
            file.set_band_description(number, text)
    return path


def test_the_band_that_is_described_as_elevations_is_read(tmp_path):
    found = ts.read(_write_bands(tmp_path / "a.tif", "uncertainty", "elevation"))
    assert found.points[:, 2].min() == 200.0
    assert any("bands number 2 is read" in one for one in found.notes)


def test_bands_of_which_none_is_an_elevation_are_refused_until_one_is_named(tmp_path):
    path = _write_bands(tmp_path / "a.tif", "std dev", "point count")
    with pytest.raises(ts.ReadError, match=r"'std dev'.*option band"):
        ts.read(path)
    assert ts.read(path, band=1).points[:, 2].min() == 100.0


def _write_netcdf(path, *, units="m", x0=752700.0, times=0, **about):
    netcdf = pytest.importorskip("netCDF4")
    with netcdf.Dataset(path, "w") as file:
        for name, count in (("x", 4), ("y", 3), *([("time", times)] if times else [])):
            file.createDimension(name, count)
        for name, start, count in (("x", x0, 4), ("y", 4024200.0, 3)):
            axis = file.createVariable(name, "f8", (name,))
            axis[:] = start + 10 * np.arange(count)
            axis.setncatts({"units": units, "standard_name": f"projection_{name}_coordinate"})
        dimensions = ("time", "y", "x") if times else ("y", "x")
        heights = file.createVariable("h", "f4", dimensions)
        heights[:] = 30.0 + np.arange(12 * (times or 1)).reshape([times, 3, 4][not times :])
        heights.setncatts({"units": "m", **about})
    return path


@pytest.mark.parametrize("about", [{"positive": "down"}, {"standard_name": "sea_floor_depth"}])
def test_depths_of_a_raster_become_elevations(tmp_path, about):
    found = ts.read(_write_netcdf(tmp_path / "a.nc", **about), crs=CRS)
    assert (found.points[:, 2].min(), found.points[:, 2].max()) == (-41.0, -30.0)
    assert any("their sign was changed" in one for one in found.notes)
    up = _write_netcdf(tmp_path / "b.nc", **about | {"positive": "up"})
    assert ts.read(up, crs=CRS).points[:, 2].min() == 30.0


def test_a_series_of_rasters_is_refused_until_one_is_named(tmp_path):
    path = _write_netcdf(tmp_path / "a.nc", times=3)
    with pytest.raises(ts.ReadError, match=r"a series of 3 rasters .*option band"):
        ts.read(path, crs=CRS)
    assert ts.read(path, crs=CRS, band=2).points[:, 2].min() == 42.0


@pytest.mark.parametrize("unit", ["km", "ft", "degrees"])
def test_axes_in_another_unit_than_the_crs_declared_are_refused(tmp_path, unit):
    path = _write_netcdf(tmp_path / "a.nc", units=unit)
    with pytest.raises(ts.CrsError, match=f"in {unit} by what the file says"):
        ts.read(path, crs=CRS)
    assert len(ts.read(path, crs=CRS, check_crs=False)) == 12


@pytest.mark.parametrize("suffix", ["gpkg", "fgb", "parquet", "geojson"])
def test_lines_have_the_unit_that_their_layer_states(tmp_path, suffix):
    feet = ts.triangulate(SITE / np.array([1.0, 1.0, 0.3048]), crs=CRS, z_unit="ft")
    path = tmp_path / f"a.{suffix}"
    more = {"kind": "edges", "projected": True} if suffix == "geojson" else {}
    ts.write(feet if suffix == "geojson" else ts.contours(feet, interval=1), path, **more)
    survey = ts.Survey(points=SITE, crs=CRS, elevation_unit="m")
    z = np.concatenate(
        [one.coords[:, 2] for one in ts.with_lines(survey, breaklines=[path]).breaklines]
    )
    assert 319.9 <= z.min() <= z.max() <= 321.1


def test_a_crs_that_proj_cannot_transform_is_an_error_of_the_file(tmp_path):
    local = (
        'ENGCRS["Site grid",EDATUM["Site datum"],CS[Cartesian,2],AXIS["easting",east],'
        'AXIS["northing",north],LENGTHUNIT["metre",1]]'
    )
    for name in ("delimited", "ply", "flatgeobuf"):
        path = _write(name, SITE, tmp_path)
        assert ts.read(path, crs=local).crs.name == "Site grid"
    with pytest.raises(ts.CrsError, match="No transformation from Site grid"):
        ts.read(_write("delimited", SITE, tmp_path), source_crs=local, crs=CRS)


def test_strips_and_quadrilaterals_are_faces(tmp_path):
    meshio = pytest.importorskip("meshio")
    path = tmp_path / "a.ply"
    path.write_text(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
        "property double z\nelement tristrips 1\nproperty list int int vertex_indices\n"
        "end_header\n0 0 1\n1 0 1\n1 1 2\n0 1 1\n4 0 1 3 2\n"
    )
    assert {frozenset(one) for one in ts.read(path).triangles.tolist()} == {
        frozenset({0, 1, 3}),
        frozenset({1, 2, 3}),
    }
    corners = np.array([[0, 0, 1], [1, 0, 1], [1, 1, 2], [0, 1, 1], [0.5, 0, 1], [1, 0.5, 1]])
    for kind, cell in (("quad", [0, 1, 2, 3]), ("triangle6", [0, 1, 2, 4, 5, 3])):
        meshio.Mesh(corners, [(kind, np.array([cell]))]).write(
            tmp_path / f"{kind}.msh", file_format="gmsh"
        )
    assert len(ts.read(tmp_path / "quad.msh").triangles) == 2
    with pytest.raises(ts.ReadError, match="type triangle6"):
        ts.read(tmp_path / "triangle6.msh")
