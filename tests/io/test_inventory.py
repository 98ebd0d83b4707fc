"""What the headers of many files say, and where they disagree: no points are read."""

from __future__ import annotations

import json

import numpy as np
import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith.cli import main
from tinsmith.io import streaming
from tinsmith.io.inventory import take_inventory


def write_tile(folder, name, west, *, count=200, width=50.0, crs="EPSG:32616", seed=1, **options):
    """Write a tile whose points lie in a square; its corners are points."""
    rng = np.random.default_rng(seed)
    xy = np.round(rng.random((count, 2)) * width, 2)
    xy[:2] = [[0, 0], [width, width]]
    points = np.column_stack([xy + np.array([500_000 + west, 4_000_000]), rng.random(count) * 9])
    survey = ts.Survey(points=points, crs=crs)
    return ts.write(survey, folder / name, **options)


def list_kinds(found):
    return [one.kind for one in found.disagreements]


def test_files_that_fit_together_disagree_in_nothing(tmp_path):
    files = [write_tile(tmp_path, f"{k}.laz", 50.0 * k) for k in range(3)]
    found = take_inventory(files)
    assert (found.count, found.disagreements, found.overlaps) == (600, (), ())
    assert found.densities == pytest.approx([200 / 2500] * 3)
    assert {one.records for one in found.headers} == {"LAS 1.4, point format 6"}


def test_each_disagreement_is_told_with_its_files(tmp_path):
    files = [write_tile(tmp_path, f"{k}.laz", 50.0 * k, seed=k) for k in range(4)]
    files.append(write_tile(tmp_path, "zone.laz", 0.0, crs="EPSG:32617"))
    files.append(write_tile(tmp_path, "dense.laz", 300.0, count=2_000))
    files.append(write_tile(tmp_path, "half.laz", 175.0, seed=9))
    copy = tmp_path / "copy.laz"
    copy.write_bytes(files[0].read_bytes())
    damaged = tmp_path / "damaged.laz"
    damaged.write_bytes(files[0].read_bytes()[:300])
    found = take_inventory([*files, copy, damaged])
    by_kind = {one.kind: one for one in found.disagreements}
    assert sorted(by_kind) == ["copies", "crs", "density", "overlap", "unreadable"]
    assert by_kind["unreadable"].files == ("damaged.laz",)
    assert "damaged.laz" in by_kind["unreadable"].sentence
    assert by_kind["crs"].files == ("zone.laz",)
    assert "EPSG:32617" in by_kind["crs"].sentence
    assert by_kind["copies"].files == ("0.laz", "copy.laz")
    assert by_kind["density"].files == ("dense.laz",)
    pairs = {(one.first, one.second): round(one.share, 2) for one in found.overlaps}
    assert pairs == {("0.laz", "copy.laz"): 1.0, ("3.laz", "half.laz"): 0.5}
    assert found.overlaps[0].share >= found.overlaps[-1].share


def test_files_of_points_without_such_headers_are_listed(tmp_path):
    for name in ("a.csv", "b.csv"):
        (tmp_path / name).write_text("x,y,z\n1,2,3\n2,5,4\n4,1,5\n")
    found = take_inventory(sorted(tmp_path.iterdir()))
    assert (found.count, found.disagreements, found.densities) == (None, (), [])


def test_the_command_reads_headers_only_and_tells_both_ways(tmp_path, monkeypatch):
    folder = tmp_path / "lidar"
    folder.mkdir()
    for k in range(3):
        write_tile(folder, f"{k}.laz", 40.0 * k)

    def refuse(*given, **options):
        raise AssertionError("points were read")

    monkeypatch.setattr(streaming, "stream_points", refuse)
    monkeypatch.setattr("tinsmith.io.lidar.reading.stream", refuse)
    run = CliRunner().invoke(main, ["info", str(folder)])
    assert run.exit_code == 0, run.output
    for words in ("3 files", "600", "EPSG:32616", "LAS 1.4, point format 6", "MB each"):
        assert words in run.output
    assert "The bounds of files overlap: '0.laz' and '1.laz' (20% of the smaller)" in " ".join(
        run.output.split()
    )
    told = json.loads(CliRunner().invoke(main, ["info", str(folder), "--json"]).stdout)
    assert (told["points"], told["kind"], len(told["files"])) == (600, "files", 3)
    assert told["files"][0]["density"] == pytest.approx(200 / 2500)
    assert [one["kind"] for one in told["disagreements"]] == ["overlap"]
    assert [one["share"] for one in told["overlaps"]] == pytest.approx([0.2, 0.2])
    assert {"tiles", "workers", "worker_bytes", "disk_bytes", "bounds"} <= set(told)


def test_a_damaged_file_does_not_hide_the_others(tmp_path):
    write_tile(tmp_path, "a.laz", 0.0)
    (tmp_path / "b.laz").write_bytes(b"LASF" + bytes(100))
    run = CliRunner().invoke(main, ["info", str(tmp_path), "--json"])
    assert run.exit_code == 0, run.output
    told = json.loads(run.stdout)
    assert [one["files"] for one in told["disagreements"]] == [["b.laz"]]
    assert "tiles" not in told


def test_what_a_folder_has_not_is_refused(tmp_path):
    file = write_tile(tmp_path, "a.laz", 0.0)
    for more in (["--codes"], [str(file)], ["--plot", str(tmp_path / "p.png")]):
        run = CliRunner().invoke(main, ["info", str(tmp_path), *more])
        assert run.exit_code == 1, run.output
        assert "only headers are read" in run.output
    empty = tmp_path / "empty"
    empty.mkdir()
    run = CliRunner().invoke(main, ["info", str(empty)])
    assert run.exit_code == 1
    assert "empty" in run.output


def test_points_say_what_they_are(tmp_path):
    write_tile(tmp_path, "a.laz", 0.0)
    told = repr(ts.tiles(tmp_path))
    assert "200 points in 1 file, 500000 to 500050 east" in told
    assert "about 1 tile, " in told
    assert told.endswith("MB a worker>")
