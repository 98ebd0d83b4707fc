"""The choice of a format, what bad files get, and writing whole files or none."""

from __future__ import annotations

import inspect
import os
import re
import stat
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from support.faults import fault

import tinsmith as ts
from tinsmith.base.atomic import replacing, replacing_path
from tinsmith.io import (
    FormatError,
    ReadError,
    WriteError,
    find_format,
    known_formats,
    read,
    write,
)
from tinsmith.io.reading import detect
from tinsmith.io.registry.plug_in_formats import find_fault

SURVEY = "x,y,z\n1,2,3\n4,5,6\n7,8.5,9\n"
TABLE = b"1.5 2.5 3.5\n4.5 5.5 6.5\n"
GRID = b"ncols 3\nnrows 2\nxllcorner 0\n"


# ------------------------------------------------------------------ content and suffix


@pytest.mark.parametrize(
    ("name", "head", "expected"),
    [
        ("a.csv", b"x,y,z\n1,2,3\n", "delimited"),
        ("a.CSV", b"anything", "delimited"),
        ("a.tif", b"II*\x00rest", "raster"),
        ("a.txt", b"MM\x00*rest", "raster"),
        ("a.txt", b"II+\x00rest", "raster"),
        ("a.csv", b"\x89PNG\r\n\x1a\n", "raster"),
        ("a.tif", TABLE, "delimited"),
        ("a.asc", TABLE, "delimited"),
        ("a.asc", GRID, "raster"),
        ("a.asc", b"NCOLS 3\r\nNROWS 2\r\n", "raster"),
        ("a.xyz", GRID, "raster"),
        ("a.ply", b"ply\nformat ascii 1.0\n", "ply"),
        ("a.txt", b"ply\r\nformat ascii 1.0\r\n", "ply"),
        ("a.ply", TABLE, "delimited"),
        ("a.obj", b"# made\nmtllib a\nv 1 2 3\nv 4 5 6\nf 1 2 3\n", "obj"),
        ("a.txt", b"v 1 2 3\nv 4 5 6\nf 1 2 3\n", "obj"),
        ("a.stl", b"solid x\n facet normal 0 0 1\n", "stl"),
        ("a.stl", b"\x01" * 84, "stl"),
        ("a.vtp", b'<?xml version="1.0"?>\n<VTKFile type="PolyData">', "vtk"),
        ("a.xml", b'<VTKFile type="UnstructuredGrid">', "vtk"),
        ("a.json", b'{"type": "FeatureCollection", "features": []}', "geojson"),
        ("a.nothing", b"II*\x00rest", "raster"),
        ("a.hgt", b"\x00\x01\x02\x03" * 9, "raster"),
        ("a.dem", b"ENDWELL", "raster"),
        ("a.csv", b'<?xml version="1.0"?>\n<!-- by hand -->\n<LandXML version="1.2">', "landxml"),
        ("a.txt", '\ufeff<LandXML version="1.2">'.encode("utf-16-le"), "landxml"),
        ("a.txt", b"  0\nSECTION\n  2\nHEADER\n", "dxf"),
        ("a.txt", b"999\nby hand\n0\nSECTION\n2\nENTITIES\n", "dxf"),
        ("a.txt", b"AutoCAD Binary DXF\r\n\x1a\x00rest", "dxf"),
    ],
)
def test_content_decides_before_the_suffix(name, head, expected):
    assert detect(Path(name), head).name == expected


@pytest.mark.parametrize(
    ("content", "kind"),
    [
        (b"PK\x03\x04rest", "ZIP"),
        (b"%PDF-1.7", "PDF"),
        (b"\x1f\x8b\x08", "gzip"),
        (b"<!DOCTYPE html><html>", "HTML"),
        (b"SQLite format 3\x00", "SQLite"),
    ],
)
def test_foreign_content_is_named(tmp_path, content, kind):
    path = tmp_path / "points.csv"
    path.write_bytes(content)
    assert kind in fault(FormatError, lambda: read(path))


def test_table_with_a_rasters_suffix_is_read(tmp_path):
    path = tmp_path / "points.tif"
    path.write_text(SURVEY)
    assert read(path).points.tolist() == [[1, 2, 3], [4, 5, 6], [7, 8.5, 9]]


def test_raster_with_a_tables_suffix_is_read(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    affine = pytest.importorskip("affine")
    path = tmp_path / "dem.txt"
    size = {"width": 3, "height": 2, "count": 1, "dtype": "int16"}
    with rasterio.open(
        path, "w", "GTiff", transform=affine.Affine(2, 0, 10, 0, -2, 20), **size
    ) as to:
        to.write(np.arange(6, dtype=np.int16).reshape(2, 3), 1)
    assert read(path).points[0].tolist() == [11, 19, 0]


def test_suffix_of_a_table_on_binary_data(tmp_path):
    path = tmp_path / "points.csv"
    path.write_bytes(b"\x07\x00\x01\x02" * 300)
    assert "binary" in fault(ReadError, lambda: read(path))


def test_unknown_suffix_names_the_known_ones(tmp_path):
    for name, word in (("points.abc", "'.abc'"), ("points", "no suffix")):
        (tmp_path / name).write_text(SURVEY)
        message = fault(FormatError, lambda name=name: read(tmp_path / name))
        assert word in message
        assert ".csv" in message
        assert ".tif" in message
        assert len(read(tmp_path / name, format="delimited")) == 3
        assert len(read(tmp_path / name, format="csv")) == 3


def test_unknown_binary_file(tmp_path):
    path = tmp_path / "data.bin"
    path.write_bytes(bytes(range(256)) * 20)
    assert "'.bin'" in fault(FormatError, lambda: read(path))


# ------------------------------------------------------------------ files that cannot be read


def test_missing_empty_and_folder(tmp_path):
    (tmp_path / "empty.csv").touch()
    assert "no file" in fault(ReadError, lambda: read(tmp_path / "missing.csv"))
    assert "folder" in fault(ReadError, lambda: read(tmp_path))
    assert "empty" in fault(ReadError, lambda: read(tmp_path / "empty.csv"))
    assert "no file" in fault(ReadError, lambda: read(str(tmp_path / "missing.csv")))
    fault(ReadError, lambda: read("a\x00b.csv"))


def test_file_without_permission(tmp_path, monkeypatch):
    path = tmp_path / "secret.csv"
    path.write_text(SURVEY)

    def refuse(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", refuse)
    assert "permission" in fault(ReadError, lambda: read(path))


def test_format_by_name_prevails(tmp_path):
    path = tmp_path / "points.csv"
    path.write_text(SURVEY)
    assert "'abc'" in fault(FormatError, lambda: read(path, format="abc"))
    fault(ReadError, lambda: read(path, format="ply"))
    pytest.importorskip("rasterio")
    fault(ReadError, lambda: read(path, format="raster"))


def test_format_that_is_only_written(tmp_path):
    path = tmp_path / "a.tif"
    path.write_bytes(b"II*\0")
    message = fault(FormatError, lambda: read(path, format="cog"))
    assert "written, not read" in message
    assert ".csv" in message


def test_unknown_option_names_those_there_are(tmp_path):
    path = tmp_path / "points.csv"
    path.write_text(SURVEY)
    message = fault(FormatError, lambda: read(path, bnad=1))
    assert message.startswith("Unknown option bnad to read")
    assert "columns, delimiter, decimal" in message
    with pytest.raises(FormatError) as caught:
        write(read(path), tmp_path / "b.csv", precision=3)
    assert caught.value.known == ("columns", "delimiter", "header")


def test_writers_are_found_by_suffix(tmp_path):
    survey = ts.Survey(points=np.eye(3))
    assert "'.abc'" in fault(FormatError, lambda: write(survey, tmp_path / "a.abc"))
    assert "not written" in fault(FormatError, lambda: write(survey, tmp_path / "a.hgt"))
    assert "holds a Raster, not a Survey" in fault(
        FormatError, lambda: write(survey, tmp_path / "a.tif")
    )
    assert write(survey, str(tmp_path / "a.CSV")) == tmp_path / "a.CSV"
    assert write(survey, tmp_path / "b.abc", format="csv").exists()


# ------------------------------------------------------------------ the registry


def test_every_reader_and_writer_is_there():
    for one in known_formats():
        assert find_fault(one) == ""
        assert one.is_built_in
        assert one.read or one.write
        assert all(suffix == suffix.lower() and suffix[0] == "." for suffix in one.suffixes)
        for action in ("read", "write"):
            assert "path" not in one.options(action)
            assert {"crs", "progress"}.isdisjoint(one.options(action))


def test_formats_by_name_or_suffix():
    assert find_format("raster") is find_format(".TIF") is find_format("tiff")
    assert find_format("vtu").name == "vtk"


# ------------------------------------------------------------------ whole files or none


def test_file_appears_whole(tmp_path):
    path = tmp_path / "a.txt"
    with replacing(path, binary=False) as file:
        file.write("höhe\n")
        assert not path.exists()
    assert path.read_bytes() == "höhe\n".encode()
    with replacing(path) as file:
        file.write(b"\x00\x01")
    assert path.read_bytes() == b"\x00\x01"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt, OSError])
def test_failure_leaves_the_old_file(tmp_path, error):
    path = tmp_path / "a.txt"
    path.write_text("old")

    def fail_half_way():
        with replacing(path) as file:
            file.write(b"new")
            raise error

    with pytest.raises(WriteError if error is OSError else error):
        fail_half_way()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_full_disk_is_a_sentence(tmp_path):
    full = Path("/dev/full")
    if not full.exists():
        pytest.skip("needs a device that is always full")

    def write_to_full():
        with replacing_path(tmp_path / "a.txt") as beside:
            beside.unlink()
            beside.symlink_to(full)
            with beside.open("w") as file:
                file.write("x")

    assert "No space left" in fault(WriteError, write_to_full)
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_is_told_whatever_a_library_says(tmp_path, monkeypatch):
    """Libraries say "HDF error" or "write error"; the disk is asked before the file is removed."""
    monkeypatch.setattr("shutil.disk_usage", lambda _: SimpleNamespace(free=4096))

    def fail():
        with replacing_path(tmp_path / "a.nc") as beside:
            beside.write_text("half")
            raise RuntimeError("NetCDF: HDF error")

    assert "no space is left on the disk" in fault(WriteError, fail)
    assert list(tmp_path.iterdir()) == []


def test_places_that_cannot_be_written(tmp_path, monkeypatch):
    def attempt(path):
        with replacing(path):
            pass

    assert "no folder" in fault(WriteError, lambda: attempt(tmp_path / "none" / "a.txt"))
    assert "folder" in fault(WriteError, lambda: attempt(tmp_path))
    assert "device" in fault(WriteError, lambda: attempt(Path(os.devnull)))
    assert stat.S_ISCHR(Path(os.devnull).stat().st_mode)
    protected = tmp_path / "protected.txt"
    protected.write_text("old")
    monkeypatch.setattr(os, "access", lambda *_: False)
    assert "read-only" in fault(WriteError, lambda: attempt(protected))
    assert protected.read_text() == "old"


def test_link_stays_and_its_target_is_replaced(tmp_path):
    target, link = tmp_path / "target.txt", tmp_path / "link.txt"
    target.write_text("old")
    link.symlink_to(target)
    with replacing(link) as file:
        file.write(b"new")
    assert link.is_symlink()
    assert target.read_text() == "new"


def test_permissions_are_kept_or_those_of_a_new_file(tmp_path):
    path, plain = tmp_path / "a.txt", tmp_path / "b.txt"
    path.write_text("old")
    path.chmod(0o640)
    plain.touch()
    with replacing(path):
        pass
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    with replacing(tmp_path / "c.txt"):
        pass
    assert (tmp_path / "c.txt").stat().st_mode == plain.stat().st_mode


def test_file_beside_has_the_same_suffix(tmp_path):
    with replacing_path(tmp_path / ("n" * 240 + ".vtp")) as beside:
        assert beside.suffix == ".vtp"
        assert beside.parent == tmp_path


@pytest.mark.parametrize("name", [1, None, b"ply", ["ply"], ""])
def test_a_name_that_is_no_text_is_no_format(name):
    with pytest.raises(ts.FormatError, match=r"^Unknown format .*: one of "):
        ts.find_format(name)


@pytest.mark.parametrize(("action", "function"), [("read", ts.read), ("write", ts.write)])
def test_help_names_the_options_of_every_format(action, function):
    text = inspect.getdoc(function)
    listed = text.split("**options\n", 1)[1].split("\n\n", 1)[0]
    named = set(re.findall(r"``(\w+)``", listed))
    able = [one for one in ts.known_formats() if getattr(one, action) is not None]
    built_in = [one for one in able if one.is_built_in]
    assert named == {option for one in built_in for option in one.options(action)}
