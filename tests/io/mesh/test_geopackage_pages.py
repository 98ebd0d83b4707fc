"""Tables written as pages hold what SQLite writes row by row; SQLite finds no fault in them."""

from __future__ import annotations

import sqlite3
from contextlib import closing

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.io.mesh.geopackage import child
from tinsmith.io.mesh.geopackage.page_reading import decode_integers, read_columns
from tinsmith.io.mesh.geopackage.pages import (
    fill_table,
    make_blobs,
    make_integers,
    make_reals,
)
from tinsmith.io.mesh.geopackage.schema import NUMBERS

COUNTS = [1, 2, 3, 127, 128, 129, 600, 16_384, 40_000]
LARGEST = [100, 127, 128, 32_767, 32_768, 2**23 - 1, 2**23, 2**31 - 1, 2**31, 2**50]


def make_rows(count, largest=2**20, seed=0):
    """Return blobs, integers up to the largest, and reals of which some are NaN."""
    rng = np.random.default_rng(seed)
    blobs = rng.integers(0, 256, (count, 21), np.uint8).view("V21").ravel()
    integers = rng.integers(0, largest, count, endpoint=True)
    integers[-1] = largest
    reals = np.where(rng.random(count) < 0.3, np.nan, rng.normal(size=count))
    reals[:1] = -0.0
    return blobs, integers, reals


def make_file(path, page_size=4096):
    """Make a database with an empty table between two that are not; return the page of it."""
    with closing(sqlite3.connect(path, isolation_level=None)) as file:
        file.execute(f"PRAGMA page_size = {page_size}")
        file.execute("CREATE TABLE before (text TEXT)")
        file.execute("INSERT INTO before VALUES ('one')")
        file.execute(
            "CREATE TABLE rows (id INTEGER PRIMARY KEY NOT NULL, a BLOB, b INTEGER, c REAL)"
        )
        file.execute("CREATE TABLE after (text TEXT)")
        file.execute("INSERT INTO after VALUES ('two')")
        return file.execute("SELECT rootpage FROM sqlite_schema WHERE name = 'rows'").fetchone()[0]


def fill(path, root, blobs, integers, reals, at_once=10_000):
    largest = int(integers.max())
    with path.open("r+b") as file:
        fill_table(
            file,
            root,
            [
                [
                    make_blobs(blobs[start : start + at_once]),
                    make_integers(integers[start : start + at_once], largest),
                    make_reals(reals[start : start + at_once]),
                ]
                for start in range(0, len(blobs), at_once)
            ],
        )


def require_rows(path, blobs, integers, reals):
    """Compare a table with the rows that it is made of, by SQLite."""
    expected = [
        (row, bytes(blob), integer, None if np.isnan(real) else real)
        for row, (blob, integer, real) in enumerate(
            zip(blobs, integers.tolist(), reals.tolist(), strict=True), start=1
        )
    ]
    with closing(sqlite3.connect(path)) as file:
        assert file.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        assert file.execute("SELECT * FROM rows ORDER BY id").fetchall() == expected
        for row in expected[:: max(1, len(expected) // 50)]:
            assert file.execute("SELECT * FROM rows WHERE id = ?", row[:1]).fetchall() == [row]
        assert file.execute("SELECT * FROM before, after").fetchall() == [("one", "two")]
        with file:
            file.execute("INSERT INTO rows (a) VALUES (x'00')")
            file.execute("DELETE FROM rows WHERE id % 3 = 1")
        assert file.execute("PRAGMA integrity_check").fetchall() == [("ok",)]


@pytest.mark.each_value
@pytest.mark.parametrize("page_size", [512, 4096, 32768])
@pytest.mark.parametrize("count", COUNTS)
def test_rows_are_those_given(tmp_path, count, page_size):
    path = tmp_path / "a.db"
    rows = make_rows(count)
    fill(path, make_file(path, page_size), *rows)
    require_rows(path, *rows)


@pytest.mark.parametrize("largest", LARGEST)
def test_integers_of_every_width_are_kept(tmp_path, largest):
    path = tmp_path / "a.db"
    rows = make_rows(300, largest)
    fill(path, make_file(path), *rows)
    require_rows(path, *rows)


def test_parts_of_any_size_give_the_same_rows(tmp_path):
    path = tmp_path / "a.db"
    rows = make_rows(1000)
    fill(path, make_file(path, 512), *rows, at_once=7)
    require_rows(path, *rows)


def test_no_rows_leave_the_table_empty(tmp_path):
    path = tmp_path / "a.db"
    root = make_file(path)
    before = path.read_bytes()
    with path.open("r+b") as file:
        fill_table(file, root, [])
    assert path.read_bytes() == before


def test_the_page_of_the_lock_byte_holds_no_rows(tmp_path):
    path = tmp_path / "a.db"
    size = 32768
    root = make_file(path, size)
    count = 2**30 // size - 3
    with path.open("r+b") as file:  # a sparse file: pages of no table up to 1 GiB
        file.truncate(count * size)
        file.seek(28)
        file.write(count.to_bytes(4, "big"))
    rows = make_rows(40_000)
    fill(path, root, *rows)
    assert path.stat().st_size > 2**30 + size
    with path.open("rb") as file:
        file.seek(2**30)
        assert file.read(size) == bytes(size)
    with closing(sqlite3.connect(path)) as file:
        faults = [fault for (fault,) in file.execute("PRAGMA integrity_check(1000000)")]
        assert all("is never used" in fault for fault in faults)
        found = file.execute("SELECT count(*), sum(b) FROM rows").fetchone()
        assert found == (40_000, rows[1].sum())


def test_a_table_with_rows_and_a_file_that_changed_are_refused(tmp_path):
    path = tmp_path / "a.db"
    root = make_file(path)
    fill(path, root, *make_rows(2))
    with pytest.raises(ts.WriteError, match="is not empty"):
        fill(path, root, *make_rows(2))
    root = make_file(tmp_path / "b.db")
    with (tmp_path / "b.db").open("ab") as file:
        file.write(b"x")
    with pytest.raises(ts.WriteError, match="is not empty"):
        fill(tmp_path / "b.db", root, *make_rows(2))


def test_the_longest_row_that_needs_no_other_page_is_kept_a_longer_one_refused(tmp_path):
    """Of 512 bytes a row takes 477: 7 are of the header and of the other columns."""
    path = tmp_path / "a.db"
    root = make_file(path, 512)
    whole, half = np.arange(3), make_reals(np.full(3, np.nan))
    parts = [make_blobs(np.zeros(3, f"V{size}")) for size in (470, 471)]
    with path.open("r+b") as file:
        with pytest.raises(ValueError, match="longer than a page"):
            fill_table(file, root, [[parts[1], make_integers(whole, 9), half]])
        fill_table(file, root, [[parts[0], make_integers(whole, 9), half]])
    require_rows(path, np.zeros(3, "V470"), whole, np.full(3, np.nan))


def test_level_triangles_have_no_aspect(tmp_path):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(30.0), np.arange(30.0)))
    tin = ts.triangulate(np.column_stack([x, y, np.maximum(0, x - 15)]))
    path = ts.write(tin, tmp_path / "a.gpkg")
    with closing(sqlite3.connect(path)) as file:
        assert file.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        found = file.execute("SELECT slope, aspect FROM triangles ORDER BY fid").fetchall()
    expected = zip(ts.slope(tin).tolist(), ts.aspect(tin).tolist(), strict=True)
    assert found == [(slope, None if np.isnan(aspect) else aspect) for slope, aspect in expected]
    assert {aspect is None for _, aspect in found} == {True, False}


# ------------------------------------------------------------------ read again


@pytest.mark.each_value
@pytest.mark.parametrize("page_size", [512, 4096, 32768])
@pytest.mark.parametrize("count", COUNTS)
def test_rows_written_are_read_from_their_pages(tmp_path, count, page_size):
    path = tmp_path / "a.db"
    root = make_file(path, page_size)
    blobs, integers, reals = make_rows(count)
    fill(path, root, blobs, integers, reals, at_once=700)
    with path.open("rb") as file:
        found = read_columns(file, root, [21, 0])
        alone = read_columns(file, root, [21, 0], skip=1)
    assert found is not None
    assert alone is not None
    assert found[0].tobytes() == blobs.tobytes()
    for column in (found[1], alone[0]):
        assert decode_integers(column).tolist() == integers.tolist()


def test_integers_of_one_to_four_bytes_keep_their_sign():
    for width in (1, 2, 3, 4):
        values = np.array([0, 1, -1, 2 ** (8 * width - 1) - 1, -(2 ** (8 * width - 1))])
        content = values.astype(">i8").view(np.uint8).reshape(-1, 8)[:, 8 - width :]
        assert decode_integers(content).tolist() == values.tolist()


def change(path, statement):
    with closing(sqlite3.connect(path)) as file, file:
        file.execute(statement)


@pytest.mark.parametrize(
    "statement",
    [
        "DELETE FROM rows WHERE id = 300",
        "UPDATE rows SET id = 70000 WHERE id = 300",
        "UPDATE rows SET b = 1 WHERE id = 300",
        "UPDATE rows SET b = NULL WHERE id = 300",
        "UPDATE rows SET a = x'00' WHERE id = 300",
        "DELETE FROM rows",
    ],
)
def test_pages_that_another_program_changed_are_left_to_it(tmp_path, statement):
    path = tmp_path / "a.db"
    root = make_file(path)
    fill(path, root, *make_rows(600))
    change(path, statement)
    with path.open("rb") as file:
        assert read_columns(file, root, [21, 0]) is None


@pytest.mark.slow
def test_what_is_no_table_is_left_to_sqlite(tmp_path):
    path = tmp_path / "a.db"
    root = make_file(path, 512)
    fill(path, root, *make_rows(5000))
    whole = path.read_bytes()
    with path.open("rb") as file:
        for page in (0, 1, root + 1, 2**31):
            assert read_columns(file, page, [21, 0]) is None
        assert read_columns(file, root, [20, 0]) is None
        assert read_columns(file, root, [21, 5]) is None
    top = (root - 1) * 512
    for place in range(top, top + 512, 3):  # a tree that leads anywhere, or round in a circle
        for value in (0, root, 255):
            path.write_bytes(whole[:place] + bytes([value]) + whole[place + 1 :])
            with path.open("rb") as file:
                found = read_columns(file, root, [21, 0])
                assert found is None or len(found[0]) == len(found[1])


@pytest.mark.parametrize("is_compact", [False, True])
def test_a_tin_is_read_from_pages_as_sqlite_reads_it(tmp_path, is_compact):
    points = np.random.default_rng(3).random((3000, 3)) * 1000
    tin = ts.triangulate(points, breaklines=[[[1, 1, 5], [999, 999, 5]]])
    path = ts.write(tin, tmp_path / "a.gpkg", compact=is_compact)
    table = NUMBERS if is_compact else "triangles"
    with closing(sqlite3.connect(path)) as file:
        query = "SELECT data FROM tinsmith_tin WHERE name = 'digests'"
        digests = file.execute(query).fetchone()[0].decode()
        found = child._read_as_written(str(path), file, table, digests)
        rows = child._read_triangles(file, table, path.stat().st_size)
        assert found is not None
        assert (found["points"] == child._read_points(file)).all()
        assert (found["triangles"] == rows["corners"]).all()
        assert (found["flags"] == rows["flags"]).all()
        other = digests.replace('"mesh": "', '"mesh": "0')
        assert child._read_as_written(str(path), file, table, other) is None
        assert child._read_as_written(str(path), file, table, "[") is None
    change(path, f"UPDATE {table} SET a = b, b = a WHERE fid = 7")
    with closing(sqlite3.connect(path)) as file:
        assert child._read_as_written(str(path), file, table, digests) is None
    change(path, "ALTER TABLE vertices ADD COLUMN more")
    with closing(sqlite3.connect(path)) as file:
        assert child._read_as_written(str(path), file, table, digests) is None
