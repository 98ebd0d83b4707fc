"""The zip in QGIS's own program, and the environment that the plugin makes."""

from __future__ import annotations

import base64
import hashlib
import json
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from support.qgis_plugin import PLUGIN, drive, make_environment, pack_plug_in, require_qgis

import tinsmith as ts

SURVEY = PLUGIN.parent / "sample_data" / "site_survey.csv"
PROGRAM = "qgis_process.bin"
"""Debian's qgis_process is a wrapper that fails on every call."""


def install_zip(folder):
    """Unpack the plugin where a profile has its plugins, and return their folder."""
    with zipfile.ZipFile(pack_plug_in("qgis", folder / "plugin.zip")) as packed:
        packed.extractall(folder / "plugins")
    return folder / "plugins"


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_the_zip_runs_in_qgis_process(tmp_path):
    require_qgis()
    program = shutil.which(PROGRAM) or shutil.which("qgis_process")
    if program is None:
        pytest.skip("needs qgis_process")
    environment = make_environment(tmp_path) | {"QGIS_PLUGINPATH": str(install_zip(tmp_path))}

    def run(*arguments):
        done = subprocess.run(
            [program, *arguments],
            capture_output=True,
            text=True,
            timeout=800,
            check=False,
            env=environment,
            cwd=tmp_path,
        )
        return done.returncode, done.stdout + done.stderr

    code, said = run("plugins", "enable", "tinsmith")
    assert code == 0, said
    given = (f"--INPUT_FILE={SURVEY}", "--INTERVAL=1", "--EXTRA=--crs EPSG:32616")
    code, said = run("run", "tinsmith:contours", *given, "--OUTPUT=lines.gpkg")
    assert code == 0, said
    wanted = ts.contours(ts.triangulate(ts.read(SURVEY, crs="EPSG:32616")), interval=1)
    import pyogrio

    assert pyogrio.read_info(tmp_path / "lines.gpkg")["features"] == len(wanted)
    code, said = run("run", "tinsmith:contours", *given, "--SMOOTH=-1", "--OUTPUT=none.gpkg")
    assert code != 0
    assert not (tmp_path / "none.gpkg").exists()


# ------------------------------------------------------------------- the environment

TOLD = """
import sys

def main():
    print("tinsmith 7.7.7" if sys.argv[1:] == ["--version"] else "")
"""


def make_wheel(folder, name, code=TOLD):
    """Return a wheel with a command tinsmith that tells its version and nothing else."""
    about = f"{name}-7.7.7.dist-info"
    files = {
        "stand_in.py": code,
        f"{about}/METADATA": f"Metadata-Version: 2.1\nName: {name}\nVersion: 7.7.7\n",
        f"{about}/WHEEL": "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\n"
        "Tag: py3-none-any\n",
    }
    if name == "tinsmith":
        files[f"{about}/entry_points.txt"] = "[console_scripts]\ntinsmith = stand_in:main\n"
    records = [
        f"{path},sha256={encode_digest(text)},{len(text.encode())}" for path, text in files.items()
    ]
    files[f"{about}/RECORD"] = "\n".join([*records, f"{about}/RECORD,,"]) + "\n"
    path = folder / f"{name}-7.7.7-py3-none-any.whl"
    with zipfile.ZipFile(path, "w") as packed:
        for one, text in files.items():
            packed.writestr(one, text)
    return path


def encode_digest(text):
    digest = hashlib.sha256(text.encode()).digest()
    return base64.urlsafe_b64encode(digest).rstrip(b"=").decode()


def job(cancel_at=None, **parameters):
    plain = {key: str(value) for key, value in parameters.items()}
    told = {"algorithm": "tinsmith:install", "parameters": plain}
    return told | ({"cancel_at": cancel_at} if cancel_at else {})


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_an_environment_is_made_on_request_and_whole(tmp_path):
    good, other = make_wheel(tmp_path, "tinsmith"), make_wheel(tmp_path, "another")
    jobs = {
        "before": job(),
        "missing": job(SOURCE=tmp_path / "none.whl", PYTHON=sys.executable),
        "other": job(SOURCE=other, PYTHON=sys.executable),
        "python": job(SOURCE=good, PYTHON=shutil.which("true")),
        "install": job(SOURCE=good, PYTHON=sys.executable),
        "cancel": job("Installing", SOURCE=good, PYTHON=sys.executable),
        "again": job(SOURCE=good, PYTHON=sys.executable),
        "after": job(),
    }
    nowhere = tmp_path / "bin"
    nowhere.mkdir()
    told = drive(tmp_path, {}, jobs, PATH=str(nowhere), PIP_NO_INDEX="1", PIP_NO_INPUT="1")
    assert "There is no command tinsmith" in told["before"]["error"]
    assert "is not installed" in told["missing"]["error"]
    assert "it is another package" in told["other"]["error"]
    assert "no Python of version 3.11 or newer" in told["python"]["error"]
    assert told["cancel"]["error"].startswith("Cancelled")
    for name in ("install", "again", "after"):
        assert told[name]["error"] is None, told[name]
        assert told[name]["outputs"]["VERSION"] == "tinsmith 7.7.7"
    first, last = (Path(told[name]["outputs"]["COMMAND"]) for name in ("install", "after"))
    assert not first.exists()
    assert last.exists()
    kept = [path.name for path in last.parents[2].iterdir()]
    assert kept == [last.parents[1].name]
    assert json.dumps(told["after"]["log"]).count("installed for this profile") == 1
