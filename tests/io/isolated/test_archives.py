"""Compressed files: one set of data is read; bombs, slips and riddles are refused."""

import gzip
import io
import re
import zipfile
from pathlib import Path

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.io import ReadError, read
from tinsmith.io.isolated import archives

ROWS = b"x,y,z\n0,0,5\n4,0,6\n0,3,8.25\n"
SAMPLES = Path(__file__).parents[3] / "sample_data"


def pack(path, **files):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return path


def refuse(path):
    with pytest.raises(ReadError) as caught:
        read(path)
    message = str(caught.value)
    assert str(path) in message
    assert "tinsmith-" not in message
    return message


def test_gzip_holds_one_file(tmp_path):
    path = tmp_path / "survey.csv.gz"
    path.write_bytes(gzip.compress(ROWS))
    survey = read(path)
    assert survey.points.tolist() == [[0, 0, 5], [4, 0, 6], [0, 3, 8.25]]
    assert survey.source == "survey.csv.gz"


def test_a_raster_in_a_zip_archive(tmp_path):
    pytest.importorskip("rasterio")
    path = tmp_path / "dem.tif.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.write(SAMPLES / "jacksboro.tif", "tiles/jacksboro.tif")
        archive.writestr("tiles/README.txt", "how it was made")
        archive.writestr("__MACOSX/tiles/._jacksboro.tif", "shadow")
    expected = read(SAMPLES / "jacksboro.tif", stride=9)
    assert np.array_equal(read(path, stride=9).points, expected.points)


def test_hidden_files_in_a_folder_are_not_data(tmp_path):
    path = pack(tmp_path / "a.zip", **{"tiles/a.csv": ROWS, "tiles/.b.csv": b"1,2,3\n"})
    assert len(read(path).points) == 3


def test_a_zipped_shapefile(tmp_path):
    pytest.importorskip("pyogrio")
    points = np.random.default_rng(1).random((9, 3)) + np.array([752_640, 4_024_180, 300])
    ts.write(ts.Survey(points=points, crs="EPSG:32616"), tmp_path / "spots.shp")
    path = tmp_path / "spots.shp.zip"
    with zipfile.ZipFile(path, "w") as archive:
        for part in tmp_path.glob("spots.[!z]*"):
            if part != path:
                archive.write(part, part.name)
    found = read(path)
    assert np.array_equal(found.points, points)
    assert found.crs == "EPSG:32616"


def test_a_text_among_texts_alone_is_the_data(tmp_path):
    assert len(read(pack(tmp_path / "s.zip", **{"points.txt": ROWS}))) == 3


@pytest.mark.parametrize(
    ("files", "words"),
    [
        ({"a.csv": ROWS, "b.csv": ROWS}, "several files (a.csv, b.csv)"),
        ({f"{k}.csv": ROWS for k in range(8)}, "3 more"),
        ({"a.txt": ROWS, "b.txt": ROWS}, "several files"),
        ({"../a.csv": ROWS}, "outside"),
        ({"/etc/a.csv": ROWS}, "outside"),
        ({"x/../../a.csv": ROWS}, "outside"),
        ({"C:\\a.csv": ROWS}, "outside"),
        ({"..\\a.csv": ROWS}, "outside"),
        ({"readme.md": b"x"}, "no data"),
        ({f"{k}.csv": b"" for k in range(1001)}, "1,001 files"),
        ({"[Content_Types].xml": b"", "xl/book.xml": b""}, "Office"),
    ],
)
def test_what_is_not_plain_is_refused(tmp_path, files, words):
    assert words in refuse(pack(tmp_path / "s.zip", **files))
    assert [one.name for one in tmp_path.rglob("*")] == ["s.zip"]


def test_links_and_encrypted_files_are_refused(tmp_path):
    path = tmp_path / "s.zip"
    with zipfile.ZipFile(path, "w") as archive:
        link = zipfile.ZipInfo("a.csv")
        link.external_attr = 0o120777 << 16
        archive.writestr(link, "/etc/passwd")
    assert "outside" in refuse(path)
    content = bytearray(pack(path, **{"a.csv": ROWS}).read_bytes())
    content[6] |= 1
    content[content.index(b"PK\x01\x02") + 8] |= 1
    path.write_bytes(content)
    assert "encrypted" in refuse(path)


def test_bombs_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(archives, "_LEAST", 1 << 20)
    zeros = bytes(5 << 20)
    (tmp_path / "b.csv.gz").write_bytes(gzip.compress(zeros))
    assert "limit" in refuse(tmp_path / "b.csv.gz")
    assert "limit" in refuse(pack(tmp_path / "b.zip", **{"a.csv": zeros}))
    lying = bytearray(pack(tmp_path / "b.zip", **{"a.csv": zeros}).read_bytes())
    place = lying.index(b"PK\x01\x02") + 24
    lying[place : place + 4] = (10).to_bytes(4, "little")
    (tmp_path / "b.zip").write_bytes(lying)
    refuse(tmp_path / "b.zip")


def test_an_archive_in_an_archive_is_not_unpacked_twice(tmp_path):
    inner = io.BytesIO()
    with zipfile.ZipFile(inner, "w") as archive:
        archive.writestr("a.csv", ROWS)
    with pytest.raises(ts.TinsmithError, match="ZIP"):
        read(pack(tmp_path / "s.zip", **{"inner.zip": inner.getvalue()}))


@pytest.mark.parametrize("name", ["s.csv.gz", "s.zip"])
def test_damaged_archives(tmp_path, name):
    path = tmp_path / name
    whole = gzip.compress(ROWS * 50)
    if name == "s.zip":
        whole = pack(path, **{"a.csv": ROWS * 50}).read_bytes()
    rng = np.random.default_rng(1)
    for _ in range(60):
        content = bytearray(whole)
        for place in rng.integers(2, len(content), 3):
            content[place] = int(rng.integers(256))
        path.write_bytes(content[: int(rng.integers(20, len(content) + 1))])
        try:
            read(path)
        except ts.TinsmithError as error:
            assert str(path) in str(error)  # noqa: PT017 - it may be read as well


def test_one_of_several_files_is_named_as_gdal_and_fsspec_do(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with zipfile.ZipFile("site.zip", "w") as archive:
        for number in (1, 2):
            archive.writestr(
                f"in/{number}.csv", f"number,easting,northing,elevation\n7,1,2,{number}\n"
            )
    ways = ("/vsizip/site.zip/in/2.csv", f"/vsizip/{tmp_path}/site.zip/in/2.csv",
            Path(f"/vsizip/{tmp_path}/site.zip/in/2.csv"), "zip://site.zip!in/2.csv",
            "zip://site.zip!/in/2.csv")  # fmt: skip
    for way in ways:
        found = ts.read(way)
        assert (found.points[:, 2].tolist(), found.source) == ([2.0], "2.csv")
    for way, sentence in {
        "/vsizip/site.zip/3.csv": "'site.zip' has no file '3.csv': it holds in/1.csv, in/2.csv.",
        "/vsizip/none.zip/3.csv": "There is no file 'none.zip'.",
        "site.zip": "or name the one to read, as '/vsizip/ARCHIVE.zip/in/1.csv'.",
    }.items():
        with pytest.raises(ts.ReadError, match=re.escape(sentence)):
            ts.read(way)
    Path("broken.zip").write_bytes(Path("site.zip").read_bytes()[:60])
    with pytest.raises(ts.ReadError, match="it may be damaged"):
        ts.read("/vsizip/broken.zip/in/1.csv")
