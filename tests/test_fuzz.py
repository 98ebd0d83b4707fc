"""The runner of random campaigns, with defects planted for it to find."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from fuzz import minimise, readers, samples
from support import point_sets

from tinsmith.io import reading
from tinsmith.io.registry.lookup import known_formats

TESTS = Path(__file__).parent


def fuzz(*arguments: object, timeout: float = 550) -> subprocess.CompletedProcess[str]:
    """Run the command line in a process of its own, as `make fuzz` does."""
    command = [sys.executable, "-m", "fuzz", "--jobs", "1", *map(str, arguments)]
    return subprocess.run(
        command,
        env={**os.environ, "PYTHONPATH": str(TESTS)},
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
    )


def run_planted(folder: Path, name: str, *arguments: object):
    """Run a planted campaign; return the process and the find that it wrote."""
    planted = ("--module", "support.planted_campaigns", "--folder", folder)
    done = fuzz(
        *planted, "--shrink-seconds", 3, "--campaign", name, *(arguments or ("--cases", 20))
    )
    files = sorted(folder.glob(f"{name}-*.json"))
    return done, [json.loads(file.read_text()) for file in files], files


# ---------------------------------------------------------------------- the runner


def test_a_planted_failure_is_found_minimised_and_replayed(tmp_path):
    done, (find,), (file,) = run_planted(tmp_path, "fails")
    assert done.returncode == 1
    assert find["case"]["word"] == ""
    assert len(find["case"]["numbers"]) == 1
    assert find["case"]["numbers"][0] > 900
    assert "a number above 900" in done.stdout
    assert f"--only {find['number']}" in done.stdout
    planted = ("--module", "support.planted_campaigns")
    again = fuzz(*planted, "--replay", file)
    assert again.returncode == 1
    assert "a number above 900" in again.stdout
    only = ("--campaign", "fails", "--folder", tmp_path, "--only")
    assert fuzz(*planted, *only, find["number"]).returncode == 1


@pytest.mark.slow
def test_the_other_cases_at_the_place_of_a_find_are_noted(tmp_path):
    done, (find,), _ = run_planted(tmp_path, "fails", "--cases", 60)
    row = next(line for line in done.stdout.splitlines() if line.startswith("fails"))
    assert len(find["others"]) == int(row.split()[3]) - 1 > 0
    assert f"also in fails, cases {find['others'][0]}" in done.stdout
    planted = ("--module", "support.planted_campaigns", "--campaign", "fails")
    for number in (find["number"], *find["others"][:2]):
        only = fuzz(*planted, "--folder", tmp_path / "again", "--only", number)
        assert f"case {number}: {find['where']}" in only.stdout


def test_a_find_that_is_mended_replays_as_sound(tmp_path):
    find = {"campaign": "fails", "seed": 1, "number": 0, "case": {"numbers": [3], "word": ""}}
    (tmp_path / "find.json").write_text(json.dumps(find))
    done = fuzz("--module", "support.planted_campaigns", "--replay", tmp_path / "find.json")
    assert (done.returncode, done.stdout) == (0, "small\n")


@pytest.mark.every_case("slow")
@pytest.mark.parametrize(
    ("name", "kind", "where"),
    [
        pytest.param("hangs", "hang", "hang", marks=pytest.mark.slow),
        ("aborts", "crash", "SIGABRT"),
        ("swells", "error", "MemoryError"),
    ],
)
def test_planted_hangs_crashes_and_blow_ups_are_finds(tmp_path, name, kind, where):
    done, (find,), _ = run_planted(tmp_path, name, "--cases", 8)
    assert done.returncode == 1
    assert find["kind"] == kind
    assert find["where"].startswith(where)
    assert max(find["case"]["numbers"]) > 950


def test_a_failure_that_depends_on_earlier_cases_is_told_so(tmp_path):
    done, finds, _ = run_planted(tmp_path, "depends")
    assert done.returncode == 1
    assert "does not recur alone" in done.stdout
    assert len(finds[0]["case"]["numbers"]) == 12


def test_sound_cases_are_counted_by_what_became_of_them(tmp_path):
    many, finds, _ = run_planted(tmp_path, "fails", "--cases", 60)
    row = next(line for line in many.stdout.splitlines() if line.startswith("fails"))
    words = row.replace(",", "").split()
    counted = dict(zip(words[4::2], words[5::2], strict=True))
    assert finds
    assert int(words[1]) == 60
    assert int(words[3]) + sum(int(n) for n in counted.values()) == 60


def test_an_unknown_campaign_is_refused():
    done = fuzz("--campaign", "nonesuch")
    assert done.returncode == 1
    assert "no campaign nonesuch; there are" in done.stderr


# ------------------------------------------------------------------ real campaigns


@pytest.mark.slow
def test_a_slice_of_every_campaign_finds_nothing(tmp_path):
    done = fuzz("--cases", 6, "--seed", 20, "--folder", tmp_path)
    assert done.returncode == 0, done.stdout


@pytest.mark.proof
@pytest.mark.timeout(3600)
def test_a_longer_slice_of_every_campaign_finds_nothing(tmp_path):
    done = fuzz("--cases", 1000, "--seed", 21, "--folder", tmp_path, timeout=3500)
    assert done.returncode == 0, done.stdout


# ------------------------------------------------------------------------ its parts


def test_minimising_keeps_what_the_find_needs():
    case = {"points": [[float(i), 1.25, -7.5] for i in range(40)], "bytes": "00ff" * 50}

    def is_same(candidate):
        return [17.0] in [p[:1] for p in candidate["points"]] and "ff" in candidate["bytes"]

    small = minimise.minimise(case, is_same)
    assert small == {"points": [[17.0]], "bytes": "ff"}


@pytest.mark.parametrize("kind", point_sets.KINDS)
def test_coordinates_are_finite_pairs_and_the_same_by_seed(kind):
    made = [point_sets.coordinates(np.random.default_rng(7), 50, kind) for _ in range(2)]
    assert made[0].shape == (50, 2)
    assert np.isfinite(made[0]).all()
    assert np.array_equal(made[0], made[1])
    assert len(np.unique(made[0], axis=0)) > 2


def test_every_reader_that_is_registered_has_a_campaign(tmp_path):
    built_in = {one.name for one in known_formats() if one.read is not None and one.is_built_in}
    met = set()
    for kind in readers.KINDS:
        for name, content in samples.sample_files(kind):
            (tmp_path / kind).mkdir(exist_ok=True)
            path = readers.put_file(tmp_path / kind, kind, name, content)
            met.add(reading._choose_format(path, None).name)
    assert built_in - met == set()
