"""Tables written, and read back by pandas and the standard library."""

from __future__ import annotations

import csv
import io
import json
import math

import numpy as np
import pandas as pd
import pytest

import tinsmith as ts
from tinsmith.base.errors import FormatError

TABLE = ts.Table(
    {
        "level": np.array([0.1 + 0.2, math.nan, 1e300]),
        "a, b": np.array(["x,y", 'say "hi"\nthere', None], object),
        "count": np.array([1, -2, 3]),
        "50 %": np.array([True, False, True]),
        "narrow": np.array([0.1, 0.2, 0.3], np.float32),
    },
    units={"level": ts.Unit.of("US survey foot"), "count": None, "narrow": "m³"},
    name="storage",
    notes=["A note."],
)
HEADER = ["level (US ft)", "a, b", "count (unknown)", "50 %", "narrow (m³)"]


def test_csv_as_rfc_4180_has_it(tmp_path):
    raw = ts.write(TABLE, tmp_path / "a.csv").read_bytes()
    assert raw.count(b"\r\n") == 4
    rows = list(csv.reader(io.StringIO(raw.decode(), newline="")))
    assert rows[0] == HEADER
    assert rows[1] == ["0.30000000000000004", "x,y", "1", "true", "0.10000000149011612"]
    assert rows[2][:2] == ["", 'say "hi"\nthere']
    assert rows[3][:2] == ["1e+300", ""]


def test_pandas_reads_the_csv_back(tmp_path):
    frame = pd.read_csv(ts.write(TABLE, tmp_path / "a.csv"))
    assert list(frame.columns) == HEADER
    np.testing.assert_array_equal(frame[HEADER[0]], TABLE["level"])
    assert frame["50 %"].tolist() == [True, False, True]
    np.testing.assert_array_equal(frame[HEADER[4]].astype(np.float32), TABLE["narrow"])


def test_tabs_by_the_suffix(tmp_path):
    assert ts.write(TABLE, tmp_path / "a.tsv").read_text().splitlines()[0].split("\t") == HEADER


def test_json_with_units_and_notes(tmp_path):
    found = json.loads(ts.write(TABLE, tmp_path / "a.json").read_text())
    assert found["name"] == "storage"
    assert found["notes"] == ["A note."]
    assert found["units"] == {"level": "US ft", "count": "unknown", "narrow": "m³"}
    assert found["rows"][0]["level"] == TABLE["level"][0]
    assert found["rows"][1] == {
        "level": None,
        "a, b": 'say "hi"\nthere',
        "count": -2,
        "50 %": False,
        "narrow": float(np.float32(0.2)),
    }
    assert pd.DataFrame(found["rows"])["count"].tolist() == [1, -2, 3]


@pytest.mark.parametrize("suffix", [".csv", ".tsv", ".txt", ".json"])
def test_no_rows(tmp_path, suffix):
    path = ts.write(ts.Table({"a": np.empty(0)}), tmp_path / f"x{suffix}")
    if suffix == ".json":
        assert json.loads(path.read_text())["rows"] == []
    else:
        assert path.read_bytes() == b"a\r\n"


@pytest.mark.parametrize("suffix", [".csv", ".json"])
def test_many_rows_come_in_chunks(tmp_path, suffix, monkeypatch):
    for module in ("csv_tables", "json_tables"):
        monkeypatch.setattr(f"tinsmith.io.tables.{module}._CHUNK_ROWS", 10)
    seen = []
    made = ts.Table({"a": np.arange(25)})
    path = ts.write(made, tmp_path / f"x{suffix}", progress=seen.append)
    assert seen[-1] == 1.0
    assert len(seen) == 3
    if suffix == ".json":
        assert [row["a"] for row in json.loads(path.read_text())["rows"]] == list(range(25))
    else:
        assert pd.read_csv(path)["a"].tolist() == list(range(25))


def test_points_as_csv_read_back_as_a_survey(tmp_path):
    points = np.array([[500_000.1, 4_000_000.2, 5.5], [500_010.0, 4_000_010.0, 6.25]])
    made = ts.Features.of_points(
        points, columns={"label": ["a", "b"]}, crs="EPSG:32616", elevation_unit="ft"
    )
    path = ts.write(made, tmp_path / "a.csv")
    header = path.read_text().splitlines()[0]
    assert header == "easting (m),northing (m),elevation (ft),label"
    survey = ts.read(path, crs="EPSG:32616")
    np.testing.assert_array_equal(survey.points, points)
    assert survey.elevation_unit.name == "foot"


def test_a_column_that_is_called_as_a_coordinate(tmp_path):
    made = ts.Features.of_points([[0, 0, 1]], columns={"elevation": [2.0]})
    with pytest.raises(FormatError, match="both called 'elevation'"):
        ts.write(made, tmp_path / "a.csv")


def test_a_column_that_says_the_coordinate_again_is_written_once(tmp_path):
    made = ts.Features.of_points(
        [[0, 0, 1.5]], columns={"text": ["b"], "elevation": [1.5]}, elevation_unit="m"
    )
    lines = ts.write(made, tmp_path / "a.csv").read_text().splitlines()
    assert lines == ["easting,northing,elevation (m),text", "0.0,0.0,1.5,b"]


def test_a_table_is_no_raster_and_no_map(tmp_path):
    for suffix in (".tif", ".gpkg", ".geojson", ".ply"):
        with pytest.raises(FormatError, match="a Table can be written to"):
            ts.write(TABLE, tmp_path / f"a{suffix}")
    with pytest.raises(FormatError, match="of type int"):
        ts.write(3, tmp_path / "a.csv")
