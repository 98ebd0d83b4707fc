"""Where CI runs nothing may be skipped, and a hang is a red test."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
SKIPS = {
    "skip": "def test_it():\n    pytest.skip('no device')\n",
    "mark": "@pytest.mark.skipif(True, reason='no device')\ndef test_it():\n    pass\n",
    "xfail": "@pytest.mark.xfail(reason='no device')\ndef test_it():\n    assert False\n",
    "fixture": "@pytest.fixture\ndef far():\n    pytest.skip('no device')\n"
    "def test_it(far):\n    pass\n",
    "extra": "pytest.importorskip('no_such_extra', reason='no device')\ndef test_it():\n    pass\n",
}


def run_pytest(folder: Path, *options: str, **environment: str):
    clean = {k: v for k, v in os.environ.items() if k != "CI" and not k.startswith("PYTEST")}
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "support.no_skips", *options, str(folder)],
        env={**clean, "PYTHONPATH": str(TESTS), **environment},
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )


def write_tests(folder: Path, bodies: dict[str, str]) -> None:
    for name, body in bodies.items():
        (folder / f"test_{name}.py").write_text("import time\nimport pytest\n" + body)


@pytest.mark.slow
def test_what_is_skipped_fails_in_ci_and_passes_elsewhere(tmp_path):
    write_tests(tmp_path, SKIPS)
    elsewhere = run_pytest(tmp_path)
    assert elsewhere.returncode == 0
    assert "4 skipped, 1 xfailed" in elsewhere.stdout
    options = ("--continue-on-collection-errors", "-rfE")
    in_ci = run_pytest(tmp_path, *options, CI="true")
    assert in_ci.returncode == 1
    for name in SKIPS:
        assert f"test_{name}.py" in in_ci.stdout
    assert in_ci.stdout.count("nothing may be skipped") >= len(SKIPS)
    assert "skipped," not in in_ci.stdout
    assert "xfailed" not in in_ci.stdout
    by_option = run_pytest(tmp_path, *options, "--no-skips")
    assert by_option.returncode == 1


@pytest.mark.slow
def test_a_hang_is_a_failure_and_what_passes_passes(tmp_path):
    bodies = {"long": "def test_it():\n    time.sleep(600)\n", "fine": "def test_it():\n    pass\n"}
    write_tests(tmp_path, bodies)
    done = run_pytest(tmp_path, "--timeout", "5", CI="true")
    assert done.returncode == 1
    assert "Timeout" in done.stdout
    assert "1 failed, 1 passed" in done.stdout


def test_every_test_has_a_time_limit(pytestconfig):
    assert 0 < float(pytestconfig.getini("timeout")) <= 600
