"""Templates and superelevation of corridors, read from text and from JSON."""

import json

import numpy as np
import pytest

import tinsmith as ts

HEAD = "station,side,name,width,slope,rise,use,ratio"
ROWS = [
    "100,both,lane,3.5,-0.025,,turns,",
    "200,both,lane,5,-0.025,,turns,",
    ",left,kerb,0,,0.12,,",
    ",both,foreslope,1,-0.4,,ditch,",
    ",both,,,,,cut,1.5",
    "100,both,,,,,fill,2",
    "200,both,,,,,fill,3",
]


def make(width, ratio):
    lane = ts.Part("lane", width, -0.025, turns=True)
    kerb = ts.Part("kerb", 0, rise=0.12)
    more = {
        "ditch": [ts.Part("foreslope", 1, -0.4)],
        "cut_slope": 1.5,
        "fill_slope": ratio,
    }
    return ts.Template(ts.Side([lane, kerb], **more), ts.Side([lane], **more))


def write_both(folder, head, rows):
    """Return a table as text and the same as JSON."""
    text, objects = folder / "table.csv", folder / "table.json"
    text.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    columns = head.split(",")
    cells = [dict(zip(columns, row.split(","), strict=True)) for row in rows]
    filled = [{key: _read(cell) for key, cell in row.items() if cell} for row in cells]
    objects.write_text(json.dumps(filled), encoding="utf-8")
    return text, objects


def _read(cell):
    try:
        return float(cell)
    except ValueError:
        return cell


def test_rows_with_stations_are_templates_and_others_belong_to_all(tmp_path):
    for file in write_both(tmp_path, HEAD, ROWS):
        assert ts.read_template(file) == {100.0: make(3.5, 2.0), 200.0: make(5.0, 3.0)}


def test_without_stations_there_is_one_template(tmp_path):
    rows = [row for row in ROWS if not row.startswith("200")]
    rows = [row.removeprefix("100") for row in rows]
    for file in write_both(tmp_path, HEAD, rows):
        assert ts.read_template(file) == make(3.5, 2.0)


def test_superelevation_is_read(tmp_path):
    for file in write_both(tmp_path, "station,right,left", ["100,-0.02,-0.025", "140,-0.05,0.05"]):
        found = ts.read_superelevation(file)
        assert found.tolist() == [[100, -0.025, -0.02], [140, 0.05, -0.05]]
        assert found.dtype == np.float64


@pytest.mark.parametrize(
    ("name", "text", "read", "sentence"),
    [
        ("a.csv", f"{HEAD}\nten,both,lane,3,,,,\n", ts.read_template, "Invalid station 'ten'"),
        ("a.csv", f"{HEAD}\n0,both,lane,3,,,,\n", ts.read_template, "cut slope"),
        ("a.csv", f"{HEAD}\n", ts.read_template, "cut slope"),
        ("a.json", "{}", ts.read_template, "no list of objects"),
        ("a.json", "[1]", ts.read_template, "no list of objects"),
        ("a.json", "[{", ts.read_template, "it is no JSON"),
        ("a.json", b"\xff", ts.read_template, "it is no JSON"),
        ("a.json", '[{"side": "both", "width": [3]}]', ts.read_template, r"Invalid width \[3\]"),
        ("a.csv", "station,left\n1,2\n", ts.read_superelevation, "row 1 has the columns station, "),
        ("a.csv", "station,left,right\n1,2,x\n", ts.read_superelevation, "row 1 of 'right': 'x'"),
        ("a.csv", "station,left,right\n1,2,nan\n", ts.read_superelevation, "no number in row 1"),
        ("a.csv", "station,left,right\n", ts.read_superelevation, "no row"),
        ("a.json", "[]", ts.read_superelevation, "no row"),
        (
            "a.json",
            '[{"station": true, "left": 0, "right": 0}]',
            ts.read_superelevation,
            "no number in row 1 of 'station': True",
        ),
    ],
)
def test_what_is_none_is_refused(tmp_path, name, text, read, sentence):
    file = tmp_path / name
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(ts.ReadError, match=sentence) as caught:
        read(file)
    assert name in str(caught.value)


@pytest.mark.parametrize("read", [ts.read_template, ts.read_superelevation])
@pytest.mark.parametrize("name", ["no.csv", "no.json"])
def test_a_missing_file_is_refused(tmp_path, read, name):
    with pytest.raises(ts.ReadError, match="Cannot read"):
        read(tmp_path / name)
