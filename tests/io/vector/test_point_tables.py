"""Text tables of points as lines and rings, in the order of their rows."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.commands import run

import tinsmith as ts

UTM = "EPSG:32616"
LINE = np.array([[752710, 4024230, 321.5], [752760, 4024262.25, 322], [752755, 4024300, 320.75]])
RING = np.array([[752710, 4024230], [752790, 4024235], [752785, 4024300], [752715, 4024290.0]])


def write_table(path, rows, header="x,y,z", delimiter=","):
    lines = [delimiter.join(map(repr, row)) for row in np.asarray(rows, float).tolist()]
    head = [header.replace(",", delimiter)] if header else []
    path.write_text("\n".join([*head, *lines]) + "\n")
    return path


@given(
    rows=st.lists(
        st.tuples(*(st.floats(lo, hi) for lo, hi in ((7e5, 8e5), (4e6, 4.1e6), (300, 330)))),
        min_size=2,
        max_size=12,
        unique_by=lambda row: row[:2],
    ),
    delimiter=st.sampled_from([",", ";", "\t"]),
)
@settings(max_examples=40, deadline=None)
def test_rows_are_the_vertices_in_their_order(rows, delimiter, tmp_path_factory):
    path = write_table(tmp_path_factory.mktemp("table") / "a.csv", rows, delimiter=delimiter)
    notes = []
    (line,) = ts.read_lines(path, crs=UTM, notes=notes)
    assert line.coords.tolist() == [list(row) for row in rows]
    assert f"its {len(rows)} points are one line in the order of its rows" in notes[-1]
    (plane,) = ts.read_lines(path, crs=UTM, drape=True)
    assert plane.coords.tolist() == [list(row[:2]) for row in rows]


def test_tables_without_elevations_are_draped(tmp_path):
    path = write_table(tmp_path / "a.csv", LINE[:, :2], header="easting,northing")
    (line,) = ts.read_lines(path, crs=UTM)
    assert line.coords.tolist() == LINE[:, :2].tolist()


def test_tables_without_a_header_are_surveys(tmp_path):
    path = write_table(tmp_path / "a.txt", LINE, header="", delimiter=" ")
    (line,) = ts.read_lines(path, crs=UTM)
    assert line.coords.tolist() == LINE.tolist()


@pytest.mark.parametrize("is_closed", [False, True])
def test_rings_close_by_themselves(tmp_path, is_closed):
    rows = np.concatenate([RING, RING[: int(is_closed)]])
    path = write_table(tmp_path / "a.csv", rows, header="x,y")
    (ring,) = ts.read_rings(path, crs=UTM)
    assert ring.tolist() == RING.tolist()
    ((polygon,),) = ts.read_polygons(path, crs=UTM)
    assert polygon.tolist() == RING.tolist()


def test_columns_by_words_of_the_field_and_feet(tmp_path):
    path = write_table(tmp_path / "a.csv", LINE, header="Easting,Northing,Elevation (ft)")
    (line,) = ts.read_lines(path, crs=UTM, target_unit="m")
    assert line.coords[:, 2] == pytest.approx(LINE[:, 2] * 0.3048)


def test_degrees_come_into_the_crs(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("lon,lat,z\n-84.2,36.3,320\n-84.19,36.31,321\n")
    (line,) = ts.read_lines(path, crs=UTM)
    assert (np.abs(line.coords[:, :2] - (751500, 4021000)) < 5000).all()
    with pytest.raises(ts.CrsError, match="longitudes and latitudes"):
        ts.read_lines(path, crs=UTM, drape=True)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("x,y,z\n1,2,3\n", "'a.csv' has 1 point: a line has 2 or more"),
        ("x,y,z\n1,2,3\n2,3,\n4,5,6\n", r"1 row without an elevation .*first: line 3"),
        ("line,x,y,z\n1,0,0,5\n1,9,0,5\n2,0,9,5\n2,9,9,5\n", "a column 'line' with 2 values"),
        ("a,b\nc,d\n", "'a.csv'"),
        ("x,y,z\n1,2,3\n2,oak,4\n", "oak"),
        ("", "'a.csv' holds no points"),
    ],
)
def test_what_is_no_line_is_refused(tmp_path, monkeypatch, text, said):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(ts.ReadError, match=said):
        ts.read_lines("a.csv")


def test_tables_with_geometries_are_vector_files(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text('id,WKT\n1,"LINESTRING Z (0 0 1, 5 5 2)"\n2,"LINESTRING Z (9 9 1, 5 9 2)"\n')
    first, second = ts.read_lines(path)
    assert first.coords.tolist() == [[0, 0, 1], [5, 5, 2]]
    assert second.coords.tolist() == [[9, 9, 1], [5, 9, 2]]


# ---------------------------------------------------------------- every command that takes lines

JOBS = {
    "alignment": "alignment line.csv --json",
    "profile": "profile a.ply --line line.csv -o out.csv",
    "sections": "sections a.ply a.ply --line line.csv --interval 20 --width 10 -o out.csv",
    "stakeout": "stakeout a.ply --line line.csv --interval 20 -o out.csv",
    "corridor": "corridor a.ply line.csv lane.csv -o out.ply",
    "plan": "plan a.ply --layout strips --axis line.csv --scale 500 -o out.pdf",
    "breaklines": "build points.csv --crs EPSG:32616 --breaklines line.csv -o out.ply",
    "boundary": "build points.csv --crs EPSG:32616 --boundary ring.csv -o out.ply",
    "holes": "build points.csv --crs EPSG:32616 --holes ring.csv -o out.ply",
    "erase": "build points.csv --crs EPSG:32616 --erase ring.csv -o out.ply",
    "clip": "clip a.ply --by ring.csv -o out.ply",
    "volume": "volume a.ply --base 320 --regions ring.csv -o out.csv",
    "coregister": "coregister hills.ply hills.ply --stable ring.csv --spacing 4 -o out.ply",
    "grade": "grade a.ply --pad ring.csv --elevation 321 --cut-slope 2 --fill-slope 2 -o out.ply",
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    x, y = (one.ravel() for one in np.meshgrid(np.arange(0, 101, 10.0), np.arange(0, 101, 10.0)))
    points = np.column_stack([752700 + x, 4024220 + y, 320 + 0.02 * x + 0.01 * y])
    write_table(tmp_path / "points.csv", points)
    ts.write(ts.triangulate(points, crs=UTM, elevation_unit="m"), "a.ply")
    points[:, 2] += 5 * np.sin(x / 15) + 4 * np.cos(y / 12)
    ts.write(ts.triangulate(points, crs=UTM, elevation_unit="m"), "hills.ply")
    write_table(tmp_path / "line.csv", LINE)
    write_table(tmp_path / "ring.csv", RING, header="x,y")
    (tmp_path / "lane.csv").write_text(
        "side,name,width,slope,use,ratio\nboth,lane,1,-0.02,,\nboth,,,,cut,2\nboth,,,,fill,2\n"
    )
    return tmp_path


@pytest.mark.parametrize("job", JOBS)
def test_commands_take_tables_and_say_so(folder, job):
    done = run(*JOBS[job].split())
    assert done.exit_code == 0, done.output
    assert "is a table: its" in done.output
    assert "in the order of its rows" in done.output


@pytest.mark.every_case("slow")
@pytest.mark.parametrize("job", [name for name in JOBS if name not in ("corridor", "breaklines")])
def test_a_table_gives_what_a_vector_file_gives(folder, job):
    assert run(*JOBS[job].split()).exit_code == 0
    outputs = [path for path in folder.iterdir() if path.stem == "out"]
    own = {path.name: path.read_bytes() for path in outputs}
    ts.write(ts.Features.of_lines(LINE[:, :2], [0, 3], crs=UTM), "line.gpkg")
    closed = np.concatenate([RING, RING[:1]])
    ring = ts.Features(kind="polygons", coordinates=closed, offsets=[[0, 5], [0, 1]], crs=UTM)
    ts.write(ring, "ring.gpkg")
    words = JOBS[job].replace("line.csv", "line.gpkg").replace("ring.csv", "ring.gpkg")
    done = run(*words.split())
    assert done.exit_code == 0, done.output
    for name, content in own.items():
        assert name.endswith(("ply", "pdf")) or (folder / name).read_bytes() == content


@pytest.mark.parametrize(
    "words",
    [("flow", "--find", "paths", "--points"), ("sight", "--target-height", "1", "--eye")],
    ids=lambda words: words[0],
)
def test_points_of_tables_are_places(folder, words):
    write_table(folder / "places.csv", RING[:1] + 5, header="x,y")
    done = run(words[0], "a.ply", *words[1:], "places.csv", "-o", "out.gpkg")
    assert done.exit_code == 0, done.output
    assert "one line" not in done.output
    assert (folder / "out.gpkg").exists()


def test_a_table_to_drape_may_be_either(folder):
    done = run("drape", "a.ply", "line.csv", "-o", "out.gpkg")
    assert done.exit_code == 1
    assert "places or vertices of a line" in done.output
    assert not (folder / "out.gpkg").exists()
