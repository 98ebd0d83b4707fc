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
