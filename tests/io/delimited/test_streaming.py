"""Survey text in blocks of lines is the text read at once, or refused with the line at fault."""

import numpy as np
import pytest
from support.streams import gather, require_same

import tinsmith as ts
from tinsmith.io.delimited import survey_text, table_reader
from tinsmith.io.delimited.lines import TextLines, iterate_lines

RNG = np.random.default_rng(1)
XYZ = np.array([752_640.0, 4_024_180.0, 300.0]) + RNG.random((500, 3)) * (200, 100, 30)
UTM = "EPSG:32616"
BLOCKS = (900, 5000)


def rows_of(points, form="{0},{1:.3f},{2:.3f},{3:.2f},tree {0}"):
    return [form.format(k + 1, *row) for k, row in enumerate(points.tolist())]


def with_header(rows):
    return ["number,easting,northing,elevation,description", *rows]


@pytest.fixture(params=BLOCKS)
def small_blocks(request, monkeypatch):
    monkeypatch.setattr(survey_text, "BLOCK_BYTES", request.param)
    return request.param


def write(folder, lines, name="points.csv", ends="\n", encoding="utf-8"):
    path = folder / name
    path.write_bytes((ends.join(lines) + ends).encode(encoding))
    return path


SOUND = {
    "header": (with_header(rows_of(XYZ)), {"crs": UTM}),
    "no header": (rows_of(XYZ), {"crs": UTM, "columns": "PENZD"}),
    "by content": (rows_of(XYZ, "{1:.3f},{2:.3f},{3:.2f}"), {"crs": UTM}),
    "words": (rows_of(XYZ, "{1:.3f} {2:.3f}   {3:.2f}"), {"columns": "ENZ"}),
    "decimal commas": (
        [row.replace(".", ",") for row in rows_of(XYZ, "{1:.3f};{2:.3f};{3:.2f}")],
        {"columns": "ENZ"},
    ),
    "quotes": (with_header(rows_of(XYZ, '{0},{1},{2},{3},"a ""b"", c {0}"')), {"crs": UTM}),
    "reprojected": (with_header(rows_of(XYZ)), {"crs": "EPSG:2274", "source_crs": UTM}),
    "unit": (with_header(rows_of(XYZ)), {"crs": UTM, "elevation_unit": "ft"}),
    "whole numbers": (rows_of(np.round(XYZ), "{1:.0f},{2:.0f},{3:.0f}"), {"columns": "ENZ"}),
    "exponents": (rows_of(XYZ, "{1:.9e},{2:.17g},{3}"), {"columns": "ENZ"}),
    "short": (rows_of(XYZ[:3], "{1},{2},{3}"), {"columns": "ENZ"}),
}


@pytest.mark.each_value
@pytest.mark.parametrize("case", SOUND)
def test_blocks_are_the_whole(tmp_path, small_blocks, case):
    lines, options = SOUND[case]
    require_same(write(tmp_path, lines), chunks=(1, 1000), **options)


@pytest.mark.each_value
@pytest.mark.parametrize("ends", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1252", "utf-16", "utf-16-be"])
def test_encodings_and_line_ends(tmp_path, small_blocks, ends, encoding):
    rows = with_header(rows_of(XYZ, "{0},{1:.3f},{2:.3f},{3:.2f},Bäume {0}"))
    path = write(tmp_path, rows, ends=ends, encoding=encoding)
    survey = require_same(path, crs=UTM, chunks=(77,))
    assert survey.attributes["description"][3] == "Bäume 4"
    require_same(path, crs=UTM, chunks=(77,), encoding=encoding)


def test_blank_lines_comments_and_gaps_keep_their_line_numbers(tmp_path, small_blocks):
    rows = with_header(rows_of(XYZ))
    rows[9] = "9,752700.0,4024200.0,,no elevation"
    for at in (40, 300, 450):
        rows[at:at] = ["", "# a comment", "; another", ",,,,"]
    rows[400] = rows[400].replace(rows[400].split(",")[3], "-9999")
    path = write(tmp_path, rows)
    survey = require_same(path, crs=UTM, nodata=-9999, chunks=(7, 10**9))
    assert survey.skipped["points without elevation"] == 1
    assert survey.skipped["nodata points"] == 1
    assert survey.skipped["comment lines"] == 6
    assert survey.skipped["blank lines"] == 6


def test_bad_rows_are_left_out_where_that_is_asked_for(tmp_path, small_blocks):
    rows = with_header(rows_of(XYZ))
    for at in (20, 200, 202, 444):
        rows[at] = "1,2"
    rows[300] = "300,east,4024200.0,300.0,text"
    path = write(tmp_path, rows)
    survey = require_same(path, crs=UTM, skip_bad=True, chunks=(7, 10**9))
    assert survey.skipped == {"bad rows": 5, "header lines": 1}


@pytest.mark.parametrize(
    ("row", "what"),
    [
        ("400,east,4024200.0,300.0,text", "line 401: easting"),
        ("400,752700.0", "line 401 has 2"),
        ("400,752700.0,4024200.0,inf,text", "line 401: elevation"),
        ('400,752700.0,4024200.0,300.0,"open', "line 401: a quote"),
        ("400,752,700.0,4024200.0,300.0,text", "line 401"),
    ],
)
def test_a_bad_row_is_refused_with_its_line(tmp_path, small_blocks, row, what):
    rows = with_header(rows_of(XYZ))
    rows[400] = row
    path = write(tmp_path, rows)
    with pytest.raises(ts.ReadError, match=what) as whole:
        ts.read(path, crs=UTM)
    with pytest.raises(ts.ReadError, match=what) as found:
        gather(path, 10, crs=UTM)
    assert found.value.lines == whole.value.lines == (401,)


def test_chunks_before_a_bad_row_are_given(tmp_path, monkeypatch):
    monkeypatch.setattr(survey_text, "BLOCK_BYTES", 900)
    rows = with_header(rows_of(XYZ))
    rows[400] = "1,2"
    with ts.io.streaming.stream_points(write(tmp_path, rows), crs=UTM, chunk_points=10) as stream:
        found = [next(stream) for _ in range(30)]
        with pytest.raises(ts.ReadError, match="line 401"):
            list(stream)
    assert np.array_equal(found[-1].rows, np.arange(292, 302))


def test_repeated_headers_and_an_end_line(tmp_path, small_blocks):
    rows = with_header(rows_of(XYZ))
    rows[100:100] = rows[:1]
    rows[321:321] = rows[:1]
    survey = require_same(write(tmp_path, [*rows, "END"]), crs=UTM, chunks=(50,), notes=False)
    assert survey.skipped["repeated header lines"] == 2
    assert survey.skipped["end lines"] == 1


@pytest.mark.parametrize("announced", [500, 499])
def test_an_announced_number_of_points(tmp_path, small_blocks, announced):
    lines = [str(announced), *rows_of(XYZ, "{1:.3f} {2:.3f} {3:.2f}")]
    require_same(write(tmp_path, lines, "points.xyz"), crs=UTM)


def test_a_last_line_that_is_cut_off(tmp_path, small_blocks):
    path = write(tmp_path, rows_of(XYZ, "{1:.3f},{2:.3f},{3:.2f}"))
    path.write_bytes(path.read_bytes()[:-2])
    require_same(path, columns="ENZ")
    require_same(path, columns="ENZ", skip_bad=True)


def test_places_outside_the_area_of_use_are_counted(tmp_path, small_blocks):
    points = XYZ.copy()
    points[[5, 250, 251, 480], 1] = 9e6
    require_same(write(tmp_path, with_header(rows_of(points))), crs=UTM)


@pytest.mark.parametrize("most", [20, 10**6])
def test_most_points_outside_the_area_of_use(tmp_path, monkeypatch, most):
    """What all rows are judged by are some of each block, and fewer of each the more there are."""
    monkeypatch.setattr(survey_text, "BLOCK_BYTES", 900)
    monkeypatch.setattr(table_reader, "_MOST_KEPT", most)
    monkeypatch.setattr(table_reader, "_SOME", 5)
    points = XYZ.copy()
    points[100:, 1] = 9.3e6
    require_same(write(tmp_path, with_header(rows_of(points))), crs=UTM, chunks=(50,))


def test_exchanged_coordinates_are_refused_at_the_end(tmp_path, small_blocks):
    path = write(tmp_path, with_header(rows_of(XYZ[:, [1, 0, 2]])))
    error = require_same(path, crs=UTM)
    assert isinstance(error, ts.CrsError)


def test_separators_of_thousands_that_the_head_does_not_show(tmp_path, small_blocks):
    """1,234 beside 512.7 may be either: whoever reads it whole refuses it, too."""
    rows = rows_of(XYZ, "{1:.3f};{2:.3f};{3:.2f}")
    rows[450] = "752,700;4024200.5;300.25"
    path = write(tmp_path, rows)
    for count in (10, 10**9):
        with pytest.raises(ts.ReadError, match="line 451"):
            gather(path, count, columns="ENZ")


def test_a_column_that_turns_out_to_be_text_stays_an_attribute(tmp_path, small_blocks):
    rows = ["easting,northing,elevation,code", *rows_of(XYZ, "{1:.3f},{2:.3f},{3:.2f},{0}")]
    rows[490] += "A"
    path = write(tmp_path, rows)
    whole = ts.read(path, crs=UTM)
    chunks, _ = gather(path, 10, crs=UTM)
    assert np.concatenate([one.points for one in chunks]).tobytes() == whole.points.tobytes()
    assert chunks[-1].attributes["description"].tolist()[-2:] == ["499", "500"]


def test_a_unit_told_behind_many_points_is_refused(tmp_path, small_blocks):
    rows = with_header(rows_of(XYZ))
    path = write(tmp_path, [*rows, "# elevations in US survey feet"])
    assert ts.read(path, crs=UTM).elevation_unit == ts.Unit.of("US survey foot")
    with pytest.raises(ts.ReadError, match="tells the unit"):
        gather(path, 10, crs=UTM)


def test_utf_8_and_windows_1252_in_one_file(tmp_path, small_blocks):
    rows = with_header(rows_of(XYZ))
    rows[1] += " ä"
    content = ("\n".join(rows) + "\n").encode() + b"501,752700.0,4024200.0,300.0,\xe4\n"
    path = tmp_path / "points.csv"
    path.write_bytes(content)
    with pytest.raises(ts.ReadError, match="UTF-8 text up to line"):
        gather(path, 10, crs=UTM)


def test_blocks_have_all_lines_once(tmp_path):
    text = "\n".join(f"line {k} {'x' * (k % 17)}" for k in range(400)) + "\n"
    (tmp_path / "a.txt").write_text(text)
    for size in (50, 333, 4000, 10**6):
        blocks = list(iterate_lines(tmp_path / "a.txt", block_bytes=size))
        found = [one.decode_line(k) for one in blocks for k in range(one.first, one.last + 1)]
        assert found == text.splitlines()
        assert [one.is_last for one in blocks] == [*[False] * (len(blocks) - 1), True]
    assert TextLines.of(b"a\nb").last == 1


def test_a_line_without_an_end_is_refused_before_memory_is_full(tmp_path, monkeypatch):
    monkeypatch.setattr(survey_text, "BLOCK_BYTES", 100_000)
    path = tmp_path / "points.csv"
    path.write_bytes(b"1,2,3\n" + b"4" * 3_000_000)
    with pytest.raises(ts.ReadError, match="line 2"):
        gather(path, 10)
