"""The plugin as a package: what the zip holds, its metadata, its types."""

from __future__ import annotations

import configparser
import re
import sys
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

import pytest
from click.testing import CliRunner
from support import processes
from support.qgis_plugin import PLUGIN, ROOT, pack_plug_in

import tinsmith
from tinsmith.cli import main
from tinsmith.cli.command_list import SUMMARIES
from tinsmith.terrain.drawing.palette import interpolate_tints, write_hex

PACKAGE = PLUGIN / "tinsmith"


def read_metadata():
    metadata = configparser.ConfigParser(interpolation=None)
    metadata.read_string((PACKAGE / "metadata.txt").read_text("utf-8"))
    return metadata["general"]


def test_the_zip_holds_the_plugin_and_nothing_else(tmp_path):
    path = pack_plug_in("qgis", tmp_path / "deep" / "a.zip")
    tracked = processes.run("git", "ls-files", "qgis/tinsmith", cwd=ROOT).stdout.split()
    untracked = processes.run(
        *("git", "ls-files", "--others", "--exclude-standard", "qgis/tinsmith"), cwd=ROOT
    )
    wanted = [name.removeprefix("qgis/") for name in tracked + untracked.stdout.split()]
    wanted = [name for name in wanted if (PLUGIN / name).exists()]
    with zipfile.ZipFile(path) as packed:
        names = packed.namelist()
        assert packed.testzip() is None
        assert names == sorted([*wanted, "tinsmith/LICENSE"])
        for name in names:
            source = ROOT / "LICENSE" if name.endswith("LICENSE") else PLUGIN / name
            assert packed.read(name) == source.read_bytes()
    assert not [name for name in names if "__pycache__" in name or "/." in name]
    assert path.stat().st_size < 1_000_000


def test_the_same_files_give_the_same_bytes(tmp_path):
    first = pack_plug_in("qgis", tmp_path / "a.zip").read_bytes()
    (PACKAGE / "metadata.txt").touch()
    assert pack_plug_in("qgis", tmp_path / "b.zip").read_bytes() == first


def test_elevations_have_the_tints_of_other_pictures():
    text = (PACKAGE / "styles.py").read_text("utf-8")
    stops = re.findall(r'\((\d\.\d+), "(#[0-9a-f]{6})"\)', text)
    ramp = write_hex(interpolate_tints(len(stops)))
    assert stops == [(str(k / (len(ramp) - 1)), color) for k, color in enumerate(ramp)]
    assert len(stops) == 5


def test_the_metadata_keep_the_rules_of_the_plugin_repository():
    told = read_metadata()
    needed = "name qgisMinimumVersion description about version author email repository tracker"
    for key in needed.split():
        assert told[key].strip(), key
    assert told["hasProcessingProvider"] == "yes"
    assert "plugin" not in told["name"].lower()
    assert re.fullmatch(r"3\.\d+", told["qgisMinimumVersion"])
    assert told["qgisMaximumVersion"] == "4.99"  # QGIS 4 lists no others
    assert (PACKAGE / told["icon"]).exists()
    for key in ("repository", "tracker", "homepage"):
        assert told[key].startswith("https://")
    assert "@" in told["email"]
    assert told["version"] == tinsmith.__version__


def test_icons_are_drawings_and_all_are_used():
    names = set()
    for path in (PACKAGE / "icons").glob("*.svg"):
        root = ET.fromstring(path.read_text())
        assert (root.get("width"), root.get("viewBox")) == ("24", "0 0 24 24")
        assert len(root) > 0
        names.add(path.stem)
    named = re.findall(r'(?:verb = |return )"([a-z]+)"', read_algorithms())
    assert names == {*named, "tinsmith"}


NO_ALGORITHM = {
    "info": "the report of 'check' and 'inspect'", "view": "a window of its own",
    "compare": "about algorithms, not data", "edit": "a script", "formats": "no data",
    "completion": "no data", "hillshade": "a renderer of QGIS", "alignment": "tables of a shell",
}  # fmt: skip
"""Commands that the plug-in leaves out, and why."""


def test_each_command_is_an_algorithm_or_left_out_for_a_reason():
    offered = set(re.findall(r'verb = "([a-z]+)"', read_algorithms()))
    assert offered | set(NO_ALGORITHM) == set(SUMMARIES)
    assert not offered & set(NO_ALGORITHM)


def read_algorithms():
    return "\n".join(path.read_text() for path in (PACKAGE / "algorithms").glob("*.py"))


def test_nothing_of_tinsmith_is_imported_inside_qgis():
    """Its libraries and those of QGIS do not live in one process."""
    modules = [path.read_text() for path in PACKAGE.rglob("*.py")]
    assert len(modules) > 15
    forbidden = r"^\s*(?:from|import) +(?:tinsmith|shapely|numpy|pandas|pyproj|rasterio|pyogrio)\b"
    assert not [text for text in modules if re.search(forbidden, text, re.MULTILINE)]


def test_nothing_is_imported_from_a_version_of_qt():
    """QGIS 4 has Qt 6, whose enumerations have names of their own."""
    for path in PACKAGE.rglob("*.py"):
        text = path.read_text()
        assert not re.search(r"(?:from|import) PyQt|\bQt\.[A-Z]|\.exec_\(", text), path


def test_the_command_begins_its_version_as_the_plugin_expects():
    said = CliRunner().invoke(main, ["--version"]).stdout.split()
    assert said[:2] == ["tinsmith", tinsmith.__version__]


@pytest.mark.slow
def test_types_of_the_plugin():
    options = ("--config-file", str(ROOT / "pyproject.toml"), "--allow-subclassing-any")
    mypy = str(Path(sys.executable).parent / "mypy")
    result = processes.run(mypy, *options, cwd=PLUGIN)
    assert result.returncode == 0, result.stdout + result.stderr
