"""Formats of plug-ins: sound ones are used as built-in ones are, faulty ones do no harm."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest
from support import plug_ins
from support.faults import fault
from support.plug_ins import Entry

import tinsmith as ts
from tinsmith.io.reading import detect

SQUARE = np.array([[0, 0, 1], [4, 0, 2], [4, 4, 3], [0, 4, 4.0]])


def read_mine(path, *, crs=None, shift=0.0):
    return ts.Survey(points=np.full((1, 3), shift), crs=crs, source=path.name)


def read_folder(path, *, crs=None):
    return ts.Survey(points=np.full((1, 3), len(list(path.iterdir()))), crs=crs)


def read_nothing(path, *, crs=None):
    return None


def read_without_crs(path):
    return None


def read_and_fail(path, *, crs=None):
    raise KeyError("height")


def write_mine(obj, path):
    path.write_text("MINE")


def write_and_fail(obj, path):
    raise RuntimeError("no ink")


def name(function):
    return f"{__name__}:{function.__name__}"


MINE = ts.Format(
    name="mine",
    description="A format of a plug-in",
    suffixes=(".mine",),
    read=name(read_mine),
    write=name(write_mine),
    sniff=lambda head: head.startswith(b"MINE"),
)


@pytest.fixture
def install(monkeypatch):
    """Return a function that makes entries the installed plug-ins."""
    yield lambda *entries: plug_ins.install(monkeypatch, *entries, group="tinsmith.formats")
    monkeypatch.undo()
    plug_ins.forget()


def told():
    """Return what is warned of as formats are listed, which is done once."""
    with pytest.warns(ts.PlugInWarning) as caught:
        ts.known_formats()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ts.known_formats()
    return [str(one.message) for one in caught]


def test_plug_in_reads_and_writes_its_files(install, tmp_path):
    install(Entry("any", MINE))
    (tmp_path / "a.csv").write_bytes(b"MINE")
    survey = ts.read(tmp_path / "a.csv", shift=2.5, crs="epsg:32616")
    assert survey.points.tolist() == [[2.5, 2.5, 2.5]]
    assert survey.crs == "EPSG:32616"
    found = ts.find_format("mine")
    assert found.options("read") == ("shift",)
    assert found.distribution == "ground-plus 1.2"
    assert not found.is_built_in
    assert ts.write(ts.triangulate(SQUARE), tmp_path / "b.mine").read_text() == "MINE"


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (ImportError("no module 'x'"), "ImportError: no module 'x'"),
        (SystemExit(3), "SystemExit: 3"),
        (AttributeError(), "AttributeError"),
        (3, "it is a int, not a Format"),
        (ts.Format, "it is a type, not a Format"),
        (replace(MINE, name="Mine"), "its name 'Mine'"),
        (replace(MINE, name=None), "its name None"),
        (replace(MINE, suffixes=".mine"), "its suffixes '.mine' are no tuple"),
        (replace(MINE, suffixes=("mine",)), "its suffix 'mine'"),
        (replace(MINE, suffixes=(3,)), "its suffix 3"),
        (replace(MINE, read=None, write=None), "neither a reader nor a writer"),
        (replace(MINE, read="read_mine"), "'module:function'"),
        (replace(MINE, read=read_mine), "'module:function'"),
        (replace(MINE, reads=("Cloud",)), "reads is ('Cloud',)"),
        (replace(MINE, writes="TIN"), "writes is 'TIN'"),
        (replace(MINE, loses=("colours",)), "loses is ('colours',)"),
        (replace(MINE, rounding=-1), "rounding"),
        (replace(MINE, side_files=(".prj",)), "its side files ('.prj',)"),
        (replace(MINE, side_files={"": ("prj",)}), "no mapping of suffixes to ends of names"),
        (replace(MINE, find_sources="x"), "'x' finds no sources"),
        (replace(MINE, sniff=b"MINE"), "b'MINE' recognises no content"),
        (replace(MINE, name="ply"), "the name 'ply' is that of a format of tinsmith"),
        (replace(MINE, name="tif"), "the name 'tif' stands for the suffix of the format raster"),
    ],
)
def test_faulty_plug_in_is_left_out_with_a_warning(install, value, reason):
    before = {one.name for one in ts.known_formats() if one.is_built_in}
    install(Entry("broken", value, "ground-minus", "0.9"), Entry("sound", replace(MINE, name="z")))
    (message,) = told()
    assert message.startswith("Plug-in ground-minus 0.9, format 'broken': ")
    assert reason in message
    assert {one.name for one in ts.known_formats()} == before | {"z"}


def test_two_plug_ins_of_one_name_keep_the_first_by_distribution(install):
    install(Entry("mine", MINE, "beta"), Entry("mine", MINE, "alpha"))
    (message,) = told()
    assert "beta 1.2" in message
    assert "alpha 1.2" in message
    assert ts.find_format("mine").distribution == "alpha 1.2"


def test_distribution_that_is_not_known(install):
    install(Entry("broken", 3, None))
    assert told()[0].startswith("Plug-in an unknown distribution, format 'broken': ")


# ------------------------------------------------------------------ claims to a suffix


def test_two_claims_to_a_suffix_are_refused_where_it_is_used(install, tmp_path):
    twin = replace(MINE, name="twin", sniff=None)
    install(Entry("a", replace(MINE, sniff=None)), Entry("b", twin, "twins", "3.0"))
    path = tmp_path / "a.mine"
    path.write_text("anything")
    claimed = (
        "is claimed by 2 formats: mine (ground-plus 1.2), twin (twins 3.0); the option `format`"
    )
    survey = ts.Survey(points=SQUARE)
    assert claimed in fault(ts.FormatError, lambda: ts.read(path))
    assert claimed in fault(ts.FormatError, lambda: ts.write(survey, path))
    assert claimed in fault(ts.FormatError, lambda: ts.find_format(".mine"))
    assert len(ts.read(path, format="twin")) == 1
    assert ts.write(survey, path, format="twin").read_text() == "MINE"


def test_a_suffix_may_be_shared_by_what_holds_other_things(install, tmp_path):
    table = replace(MINE, name="twin", read=None, writes=("Table",))
    install(Entry("a", replace(MINE, writes=("TIN",))), Entry("b", table))
    assert ts.write(ts.triangulate(SQUARE), tmp_path / "a.mine").exists()
    assert "claimed" not in fault(
        ts.FormatError, lambda: ts.write(ts.Survey(points=SQUARE), tmp_path / "a.mine")
    )


def test_built_in_format_is_not_replaced(install, tmp_path):
    install(Entry("a", replace(MINE, suffixes=(".ply",), sniff=None)))
    tin = ts.triangulate(SQUARE)
    claimed = "is claimed by 2 formats: ply (tinsmith), mine (ground-plus 1.2)"
    assert claimed in fault(ts.FormatError, lambda: ts.write(tin, tmp_path / "a.ply"))
    path = ts.write(tin, tmp_path / "a.ply", format="ply")
    assert isinstance(ts.read(path), ts.TIN)  # by its content
    assert len(ts.read(path, format="mine")) == 1


def test_content_of_a_built_in_format_is_read_by_it_and_told(install, tmp_path):
    install(Entry("a", replace(MINE, sniff=lambda head: True)))
    path = ts.write(ts.triangulate(SQUARE), tmp_path / "b.ply")
    with pytest.warns(ts.PlugInWarning, match=r"ground-plus 1\.2.*claims '.*b\.ply' too.*as ply"):
        assert isinstance(ts.read(path), ts.TIN)


def test_two_plug_ins_that_know_one_content_are_refused(install, tmp_path):
    install(Entry("a", MINE), Entry("b", replace(MINE, name="twin"), "twins", "3.0"))
    (tmp_path / "a.csv").write_bytes(b"MINE")
    message = fault(ts.FormatError, lambda: ts.read(tmp_path / "a.csv"))
    assert "mine (ground-plus 1.2), twin (twins 3.0)" in message


def test_longest_suffix_counts(install, tmp_path):
    site = replace(MINE, name="site", suffixes=(".site.json",), sniff=None)
    install(Entry("a", site))
    assert detect(tmp_path / "a.site.json", b"{}").name == "site"
    assert detect(tmp_path / "a.mine.csv", b"1,2,3\n").name == "delimited"
    tin = ts.triangulate(SQUARE)
    assert ts.write(tin, tmp_path / "a.SITE.json").read_text() == "MINE"
    assert ts.write(tin.replace(crs="EPSG:32616"), tmp_path / "a.json").read_text()[0] == "{"


# ------------------------------------------------------------------ faults in use


def test_folder_of_a_format(install, tmp_path):
    folders = replace(
        MINE, read=name(read_folder), sniff=None, sniff_folder=lambda path: path.name == "tiles"
    )
    install(Entry("a", folders))
    for folder in ("tiles", "other"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "one").touch()
    assert ts.read(tmp_path / "tiles").points.max() == 1
    assert ts.read(tmp_path / "other", format="mine").points.max() == 1
    assert "is a folder" in fault(ts.ReadError, lambda: ts.read(tmp_path / "other"))
    assert "is a folder" in fault(ts.ReadError, lambda: ts.read(tmp_path / "tiles", format="ply"))


@pytest.mark.parametrize(
    ("reader", "reason"),
    [
        (f"{__name__}:nothing", "nothing"),
        ("no_such_module:read", "no_such_module"),
        (f"{__name__}:MINE", "is not a callable"),
        (name(read_without_crs), "does not take (path, *, crs)"),
        (name(read_and_fail), "KeyError: 'height'"),
        (name(read_nothing), "it gives a NoneType"),
    ],
)
def test_reader_that_fails_is_named(install, tmp_path, reader, reason):
    install(Entry("a", replace(MINE, read=reader)))
    (tmp_path / "a.mine").write_bytes(b"MINE")
    message = fault(ts.TinsmithError, lambda: ts.read(tmp_path / "a.mine"))
    assert "mine, of the plug-in ground-plus 1.2" in message
    assert reason in message


def test_writer_that_fails_is_named(install, tmp_path):
    install(Entry("a", replace(MINE, write=name(write_and_fail))))
    write = lambda: ts.write(ts.triangulate(SQUARE), tmp_path / "a.mine")  # noqa: E731
    message = fault(ts.WriteError, write)
    assert "mine, of the plug-in ground-plus 1.2, fails (RuntimeError: no ink)" in message


def test_sniff_that_fails_is_told_and_harms_no_file(install, tmp_path):
    install(Entry("a", replace(MINE, sniff=lambda head: head.undefined)))
    (tmp_path / "a.csv").write_text("x,y,z\n1,2,3\n")
    with pytest.warns(ts.PlugInWarning, match=r"ground-plus 1\.2, format 'mine': it failed"):
        assert len(ts.read(tmp_path / "a.csv")) == 1
