"""File objects in place of files: every format into a buffer and out of one."""

import io
import warnings
import zipfile

import numpy as np
import pytest
from support.product_calls import HILL, RESULTS

import tinsmith as ts
from tinsmith.io.registry.lookup import known_formats

SURVEY = ts.Survey(points=HILL.points, crs=HILL.crs, elevation_unit="m")
OBJECTS = {
    "TIN": HILL,
    "Survey": SURVEY,
    "Features": RESULTS["contours"](HILL),
    "Raster": RESULTS["rasterize"](HILL),
    "Table": RESULTS["volume"](HILL),
    "Alignment": ts.Alignment.from_points(HILL.points[[0, 5], :2], crs=HILL.crs),
}
CASES = [
    (one.name, kind) for one in known_formats() if one.write is not None for kind in one.writes
]


@pytest.mark.parametrize(("name", "kind"), CASES)
def test_what_a_buffer_gets_is_what_a_file_has(tmp_path, name, kind):
    chosen = ts.find_format(name)
    made = OBJECTS[kind]
    path = tmp_path / f"stream{next(iter(chosen.suffixes), '')}"
    buffer = io.BytesIO(b"before ")
    buffer.seek(0, io.SEEK_END)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.LossWarning)
        try:
            ts.write(made, path, format=name)
        except ts.TinsmithError as error:
            with pytest.raises(type(error)):
                ts.write(made, buffer, format=name)
            assert buffer.getvalue() == b"before "
            return
        if path.is_dir() or len([*tmp_path.iterdir()]) > 1:
            with pytest.raises(ts.FormatError, match="holds one file"):
                ts.write(made, buffer, format=name)
            assert buffer.getvalue() == b"before "
            return
        assert ts.write(made, buffer, format=name) is buffer
    wanted = path.read_bytes()
    assert buffer.getvalue().startswith(b"before ")
    assert len(buffer.getvalue()) == 7 + len(wanted)
    if chosen.read is None or kind not in chosen.reads:
        return
    found = ts.read(path, format=name, crs=HILL.crs)
    again = ts.read(io.BytesIO(buffer.getvalue()[7:]), format=name, crs=HILL.crs)
    assert type(again) is type(found)
    np.testing.assert_array_equal(again.points, found.points)
    if isinstance(found, ts.TIN):
        assert again == found


def test_text_is_read_and_written_where_the_format_is_text(tmp_path):
    text = io.StringIO()
    assert ts.write(HILL, text, format="obj") is text
    path = ts.write(HILL, tmp_path / "a.obj")
    assert text.getvalue() == path.read_text(encoding="utf-8").replace("\r\n", "\n")
    survey = ts.read(io.StringIO("number,easting,northing,elevation\n7,1,2,3\n"))
    assert survey.points.tolist() == [[1, 2, 3]]
    with pytest.raises(ts.OptionError, match="as the format ply is binary"):
        ts.write(HILL, io.StringIO(), format="ply")


def test_a_file_that_is_open_is_called_by_its_name(tmp_path):
    path = tmp_path / "site.csv"
    path.write_text("number,easting,northing,elevation\n7,1,2,3\n8,1,x,3\n")
    with path.open("rb") as file, pytest.raises(ts.ReadError, match=r"'site\.csv'"):
        ts.read(file)
    with path.open("rb") as file:
        assert ts.read_points(file, skip_bad=True).source == "site.csv"


def test_file_objects_that_cannot_be_used_are_refused(tmp_path):
    closed = io.BytesIO()
    closed.close()
    with pytest.raises(ts.OptionError, match="a file object that can be read"):
        ts.read(closed)
    with pytest.raises(ts.OptionError, match="a file object that can be written"):
        ts.write(HILL, closed, format="ply")
    with (tmp_path / "a").open("wb") as file:
        with pytest.raises(ts.OptionError, match="a file object that can be read"):
            ts.read(file)
        with pytest.raises(ts.OptionError, match="the name of a format, such as 'ply'"):
            ts.write(HILL, file)
    with pytest.raises(ts.ReadError, match="'stream' is empty"):
        ts.read(io.BytesIO())
    with pytest.raises(ts.ReadError, match="'stream' holds points alone"):
        ts.read_tin(io.BytesIO(b"x,y,z\n1,2,3\n"))


def test_progress_ends_at_1_for_file_objects():
    told = []
    ts.read(io.BytesIO(b"x,y,z\n1,2,3\n"), progress=told.append)
    assert told[-1] == 1.0
    told = []
    ts.write(HILL, io.BytesIO(), format="ply", progress=told.append)
    assert told[-1] == 1.0


def test_a_logger_hears_what_is_read_and_written(tmp_path, caplog):
    path = tmp_path / "a.csv"
    path.write_text("number,easting,northing,elevation\n7,1,2,3\n7,4,2,3\n")
    with caplog.at_level("INFO", logger="tinsmith"):
        survey = ts.read(path)
        ts.write(survey, tmp_path / "b.csv")
    said = [one.getMessage() for one in caplog.records if one.name == "tinsmith"]
    assert said[0] == f"Read {path}: {survey!r}"
    assert said[1:-1] == [f"{path}: {note}" for note in survey.notes]
    assert said[-1] == f"Wrote {tmp_path / 'b.csv'} as delimited: {survey!r}"
    caplog.clear()
    with caplog.at_level("INFO", logger="tinsmith"):
        ts.write(survey, io.BytesIO(), format="delimited")
    assert [one.getMessage() for one in caplog.records] == [
        f"Wrote stream as delimited: {survey!r}"
    ]


# ---------------------------------------------------------------- lines, axes, tables, cells

LINE = ts.Features(
    kind="lines", coordinates=HILL.points[[0, 21, 45]], offsets=[[0, 3]], crs=HILL.crs
)
POLYGON = ts.Features(
    kind="polygons",
    coordinates=HILL.points[[0, 19, 399, 0]] * [1, 1, 0] + [0, 0, 5],
    offsets=[[0, 4], [0, 1]],
    crs=HILL.crs,
)
READERS = {
    "read_lines": (LINE, lambda lines: lines[0].coords),
    "read_rings": (POLYGON, lambda rings: rings[0]),
    "read_polygons": (POLYGON, lambda polygons: polygons[0][0]),
    "read_water": (POLYGON, lambda ponds: ponds[0].ring),
    "read_alignment": (LINE, lambda axis: axis.points_at([0.0, 10.0])),
}


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("format_name", ["gpkg", "flatgeobuf", "geoparquet", "geojson"])
def test_lines_and_rings_of_a_buffer_are_those_of_a_file(tmp_path, name, format_name):
    made, take = READERS[name]
    path = tmp_path / f"lines{ts.find_format(format_name).suffixes[0]}"
    ts.write(made, path, format=format_name)
    read = getattr(ts, name)
    wanted = take(read(path, crs=HILL.crs))
    for buffer in (io.BytesIO(path.read_bytes()), path.open("rb")):
        with buffer:
            np.testing.assert_array_equal(take(read(buffer, crs=HILL.crs)), wanted)
    with zipfile.ZipFile(tmp_path / "all.zip", "w") as archive:
        archive.write(path, path.name)
    member = f"/vsizip/{tmp_path / 'all.zip'}/{path.name}"
    np.testing.assert_array_equal(take(read(member, crs=HILL.crs)), wanted)


def test_tables_of_a_buffer(tmp_path):
    text = "side,name,width,slope,use,ratio\nboth,lane,3.5,-0.025,turns,\nboth,,,,cut,1.5\n"
    (tmp_path / "road.csv").write_text(text + "both,,,,fill,2\n")
    wanted = ts.read_template(tmp_path / "road.csv")
    assert ts.read_template(io.StringIO(text + "both,,,,fill,2\n")) == wanted
    rows = b'[{"station": 100, "left": -0.025, "right": 0.5}]'
    assert ts.read_superelevation(io.BytesIO(rows)).tolist() == [[100.0, -0.025, 0.5]]
    (line,) = ts.read_lines(io.StringIO("x,y,z\n0,0,1\n1,0,2\n"))
    assert line.coords.tolist() == [[0, 0, 1], [1, 0, 2]]


def test_faults_in_a_buffer_speak_of_its_name(tmp_path):
    with pytest.raises(ts.ReadError, match=r"^'stream\.geojson'"):
        ts.read_lines(io.BytesIO(b'{"type": "FeatureCollection", "features": []}'))
    path = tmp_path / "named.gpkg"
    path.write_bytes(b"SQLite format 3\0 and no more")
    with path.open("rb") as file, pytest.raises(ts.ReadError, match=r"^'named\.gpkg'"):
        ts.read_rings(file)
    with pytest.raises(ts.OptionError, match="cells are read as they are asked for"):
        ts.read_raster(io.BytesIO(b"II*\0"))
    with pytest.raises(ts.ReadError, match=r"stream\.tif"):
        ts.rasterize(HILL, like=io.BytesIO(b"no raster"))
