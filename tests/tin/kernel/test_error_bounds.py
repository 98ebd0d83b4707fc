"""The bounds on rounding in the core, against arithmetic of 113 bits, by a program of its own."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(os.environ.get("TINSMITH_SOURCES", Path(__file__).parents[3]))  # or mutants
COMPILER = os.environ.get("CXX") or "g++"


@pytest.mark.slow
@pytest.mark.skipif(shutil.which(COMPILER) is None, reason="needs a C++ compiler")
def test_errors_of_cotangents_stay_within_their_bounds_and_come_near_them(tmp_path):
    program = tmp_path / "cotangent_errors"
    source = ROOT / "tests" / "cpp" / "cotangent_errors.cpp"
    options = ["-std=c++17", "-O1", "-ffp-contract=off"]
    subprocess.run([COMPILER, *options, str(source), "-o", str(program)], check=True)
    done = subprocess.run([str(program)], check=True, capture_output=True, text=True)
    *shares, is_too_small = map(float, done.stdout.split())
    for share in shares:
        assert 0.01 < share <= 1.0  # bounds a hundred times tighter would not hold
    assert len(shares) == 4
    assert not is_too_small


@pytest.mark.skipif(shutil.which(COMPILER) is None, reason="needs a C++ compiler")
def test_measures_of_triangles_agree_with_their_angles_and_lengths(tmp_path):
    program = tmp_path / "triangle_shape"
    source = ROOT / "tests" / "cpp" / "triangle_shape.cpp"
    subprocess.run([COMPILER, "-std=c++17", str(source), "-o", str(program)], check=True)
    done = subprocess.run([str(program)], check=True, capture_output=True, text=True)
    assert not done.stdout
