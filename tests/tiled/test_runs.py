"""Folders of runs: what is done is kept, and only what is the same goes on."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

import pytest

import tinsmith as ts
from tinsmith.tiled.running.runs import Fingerprint, Record, Run, hash_file


def describe(path, **options):
    """Return a manifest of one input."""
    source = vars(Fingerprint.take(path)) if path else None
    return {
        "version": "1",
        "product": "raster",
        "options": {"spacing": 1.0, "classes": [2], **options},
        "inputs": [source] if source else [],
    }


@pytest.fixture
def source(tmp_path):
    """Return a file."""
    path = tmp_path / "a.las"
    path.write_bytes(b"points")
    return path


def test_a_run_begins_and_goes_on(tmp_path, source):
    run = Run(tmp_path / "out.run")
    with run.opened(describe(source), restart=False) as goes_on:
        assert not goes_on
        (run.folder / "block.npy").write_bytes(b"cells")
        files = {"block.npy": hash_file(run.folder / "block.npy")}
        run.add("tiles", Record("1", "done", points=5, files=files))
        run.add("tiles", Record("1.2", "failed", "Because."))
    with run.opened(describe(source), restart=False) as goes_on:
        assert goes_on
        found = run.read("tiles")
        assert found["1"].points == 5
        assert found["1.2"].sentence == "Because."
    (run.folder / "block.npy").write_bytes(b"other")
    assert list(run.read("tiles")) == ["1.2"]  # what it wrote is not there any more
    with run.opened(describe(source), restart=True) as goes_on:
        assert not goes_on
        assert run.read("tiles") == {}
    run.remove()
    assert not run.folder.exists()


def test_other_options_and_inputs_are_refused_with_the_difference(tmp_path, source):
    run = Run(tmp_path / "out.run")
    with run.opened(describe(source), restart=False):
        pass
    with (
        pytest.raises(ts.ReadError, match=re.escape("`spacing` was 1.0, and is 2.0")),
        run.opened(describe(source, spacing=2.0), restart=False),
    ):
        pass
    with (
        pytest.raises(ts.ReadError, match=r"'.*a\.las' is not read any more"),
        run.opened(describe(None), restart=False),
    ):
        pass
    source.write_bytes(b"pointS")
    with (
        pytest.raises(ts.ReadError, match=r"'.*a\.las' has changed\. The option `restart` begins"),
        run.opened(describe(source), restart=False),
    ):
        pass
    with run.opened(describe(source), restart=True):
        pass


def test_two_runs_in_one_folder(tmp_path, source):
    run = Run(tmp_path / "out.run")
    with (
        run.opened(describe(source), restart=False),
        pytest.raises(ts.WriteError, match="Another process works on the run"),
        run.opened(describe(source), restart=False),
    ):
        pass
    (run.folder / "lock").write_text("999999999 " + os.uname().nodename)  # of a killed process
    with run.opened(describe(source), restart=False) as goes_on:
        assert goes_on


def test_what_a_killed_run_left_beside_its_output_goes(tmp_path, source):
    run, output = Run(tmp_path / "out.run"), tmp_path / "out.tif"
    other, own, folder = (
        tmp_path / f".out-{k}2345678{end}" for k, end in enumerate(("", ".tif", ""))
    )
    other.write_text("of another program that is at work")
    with run.opened(describe(source), restart=False):
        run.clear_beside(output)
        own.write_text("half")
        folder.mkdir()
        (folder / "part.shp").write_text("half")
    with run.opened(describe(source), restart=False):
        run.clear_beside(output)
    assert (other.exists(), own.exists(), folder.exists()) == (True, False, False)


def test_a_run_that_was_killed_as_it_began(tmp_path, source):
    run = Run(tmp_path / "out.run")
    run.folder.mkdir()
    (run.folder / "lock").write_text("999999999 " + os.uname().nodename)
    (run.folder / ".run-12345678.json").write_text("{")
    with run.opened(describe(source), restart=False) as goes_on:
        assert not goes_on
        assert sorted(one.name for one in run.folder.iterdir()) == ["lock", "run.json"]


def test_a_run_that_was_killed_as_it_was_removed_is_one_still(tmp_path, source, monkeypatch):
    run, inner = Run(tmp_path / "out.run"), Run(tmp_path / "out.run" / "points")
    manifest = describe(source)
    unlink, left = Path.unlink, [0]

    def stop(path, **options):
        if not left[0]:
            raise KeyboardInterrupt
        left[0] -= 1
        unlink(path, **options)

    for most in range(8):
        with run.opened(manifest, restart=False), inner.opened(manifest, restart=False):
            for one in (run, inner):
                one.add("tiles", Record("1", "done"))
                one.add("tiles", Record("2", "done"))
                (one.folder / "tiles.json").write_text("[]")
        left[0] = most
        with monkeypatch.context() as patch:
            patch.setattr(Path, "unlink", stop)
            with pytest.raises(KeyboardInterrupt):
                run.remove()
        for one in (run, inner):
            if one.folder.exists() and one.read("tiles"):
                assert (one.folder / "tiles.json").exists()
        with run.opened(manifest, restart=False) as goes_on:
            assert goes_on
            if inner.folder.exists():
                with inner.opened(manifest, restart=False):
                    pass
    run.remove()
    assert not run.folder.exists()


def test_a_folder_of_something_else_is_left_alone(tmp_path, source):
    (tmp_path / "out.run").mkdir()
    (tmp_path / "out.run" / "thesis.txt").write_text("mine")
    run = Run(tmp_path / "out.run")
    with (
        pytest.raises(ts.WriteError, match="it holds something else"),
        run.opened(describe(source), restart=True),
    ):
        pass
    assert [one.name for one in run.folder.iterdir()] == ["thesis.txt"]


def test_a_damaged_manifest_and_damaged_records(tmp_path, source):
    run = Run(tmp_path / "out.run")
    with run.opened(describe(source), restart=False):
        run.add("tiles", Record("1", "done"))
        (run.folder / "tiles" / "2.json").write_text("{")
        (run.folder / "tiles" / "3.json").write_text(json.dumps({"other": 1}))
        assert list(run.read("tiles")) == ["1"]
    (run.folder / "run.json").write_text("{")
    with (
        pytest.raises(ts.ReadError, match="is damaged: remove the folder"),
        run.opened(describe(source), restart=False),
    ):
        pass


def test_a_file_that_changes_or_vanishes(source):
    before = Fingerprint.take(source)
    before.require_same()
    source.write_bytes(b"pointz")
    with pytest.raises(ts.ReadError, match="was changed while it was read"):
        before.require_same()
    source.unlink()
    with pytest.raises(ts.ReadError, match=r"Cannot read '.*': No such file"):
        before.require_same()
