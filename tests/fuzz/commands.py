"""Random command lines over small files: exit codes, inputs left alone, JSON that parses."""

from __future__ import annotations

import json
import os
import tempfile
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from click.testing import CliRunner

from .campaign import Campaign

_POINTS = "x,y,z\n0,0,1\n4,0,2\n4,3,3\n0,3,4\n2,1,5\n1,2,2\n"
_RING = [[1, 1], [3, 1], [3, 2], [1, 2], [1, 1]]
_POLYGON = json.dumps({"type": "Polygon", "coordinates": [_RING]})
_EDITS = json.dumps([{"op": "remove", "vertices": [4]}])
_FILES = {
    "points.csv": _POINTS,
    "plain.xyz": _POINTS.partition("\n")[2].replace(",", " "),
    "two points.csv": "x,y,z\n0,0,1\n4,0,2\n",
    "empty.csv": "",
    "nonsense.bin": "\x00\x01\x02 no table",
    "hole.geojson": _POLYGON,
    "edits.json": _EDITS,
    "codes.toml": "[codes]\nEP = 'hard'\n",
    "wrong.json": '{"op": ',
    "é-ü.csv": _POINTS,
    "new\nline.csv": _POINTS,
    "--top": _POINTS,
    "tin.obj": "v 0 0 1\nv 4 0 2\nv 4 3 3\nv 0 3 4\nf 1 2 3\nf 1 3 4\n",
}
_LINKS = {"link.csv": "points.csv", "loop.csv": "loop.csv"}
_INPUTS = (
    *_FILES,
    *_LINKS,
    "hard.csv",
    "none.csv",
    "folder",
    "locked.csv",
    "-",
    "",
    ".",
    "/dev/null",
)
_OUTPUTS = (
    *("out.ply", "out.obj", "out.stl", "out.csv", "out.geojson", "out.json", "out.png", "out"),
    *("out.tif", "none/out.ply", "folder", "folder/out.ply", "points.csv", "./points.csv", "-"),
    *("hard.csv", "link.csv", "hole.geojson", "edits.json", "folder/../tin.obj", "/dev/full"),
    *("a" * 300 + ".ply", "new\nline.ply", "-o", ""),
)
_NUMBERS = ("0", "1", "2.5", "-1", "nan", "inf", "-inf", "1e400", "1e-320", "many", "", "9" * 30)
_TEXTS = (
    "",
    "EPSG:32616",
    "EPSG:4326",
    "EPSG:0",
    "x",
    "x,y,z",
    "XYZ",
    "PNEZD",
    ";",
    "中",
    "a=b",
    "-",
)
_VALUES = {
    **dict.fromkeys(("--snap", "--max-edge", "--min-angle", "--max-area", "--max-side"), _NUMBERS),
    **dict.fromkeys(("--max-vertices", "--sample", "--threads", "--level", "--band"), _NUMBERS),
    **dict.fromkeys(("--stride", "--water-z", "--nodata", "--tolerance", "--points"), _NUMBERS),
    **dict.fromkeys(("--arc-tolerance", "--refraction"), _NUMBERS),
    "--code-style": ("words", "civil3d", "", "nope"),
    "--code-table": (*_INPUTS, "codes.toml"),
    **dict.fromkeys(("--crs", "--source-crs", "--columns", "--delimiter", "--decimal"), _TEXTS),
    **dict.fromkeys(("--duplicates", "--kind", "--crossing", "--trim"), ("mean", "lines", "error")),
    **dict.fromkeys(("--format", "--output-format"), ("ply", "csv", "raster", "obj", "", "nope")),
    **dict.fromkeys(("--breaklines", "--boundary", "--holes", "--erase", "--water"), _INPUTS),
    **dict.fromkeys(("--report", "--plot"), _OUTPUTS),
}
_WITH_VALUES = ("-o", *_VALUES)
_WRITING = ("-o", "--report", "--plot")
_FLAGS = (
    *("--json", "-q", "--codes", "--conforming", "--drape", "--projected", "--fill", "--nope"),
    "--events",
)
_COMMANDS = (
    *("build", "info", "check", "compare", "refine", "simplify", "edit", "convert", "formats"),
    "nope",
)


def generate(rng: np.random.Generator) -> dict[str, Any]:
    """Return the words of a command line."""
    command = str(rng.choice(_COMMANDS))
    words = [command]
    if rng.random() < 0.1:
        words.append("--")
    words.append(_input(rng))
    if command == "edit":
        words.append(str(rng.choice(["edits.json", "edits.json", "wrong.json", "points.csv", "-"])))
    for _ in range(int(rng.integers(1, 3)) if command not in ("info", "check") else 0):
        words += ["-o", str(rng.choice(_OUTPUTS if rng.random() < 0.5 else _OUTPUTS[:5]))]
    for _ in range(int(rng.choice([0, 0, 1, 1, 2, 3]))):
        option = str(rng.choice(list(_VALUES)))
        words += [option, str(rng.choice(_VALUES[option]))]
    words += [str(flag) for flag in rng.choice(_FLAGS, int(rng.choice([0, 1, 1, 2])))]
    return {"words": words, "stdin": str(rng.choice(["", _POINTS, "nothing"]))}


def _input(rng: np.random.Generator) -> str:
    if rng.random() < 0.5:
        return str(rng.choice(["points.csv", "plain.xyz", "tin.obj"]))
    return str(rng.choice(_INPUTS))


def examine(case: dict[str, Any]) -> str:
    """Run the command in a folder of its own."""
    from tinsmith.cli import main

    before = Path.cwd()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name).resolve()
        try:
            os.chdir(folder)
            given = _make_files(folder)
            result = CliRunner().invoke(main, case["words"], input=case["stdin"])
            _examine(case["words"], result, given, folder)
        finally:
            os.chdir(before)
            (folder / "locked.csv").chmod(0o600)
    return f"exit {result.exit_code}"


def _make_files(folder: Path) -> dict[str, bytes]:
    for name, text in _FILES.items():
        (folder / name).write_text(text, encoding="utf-8")
    for name, target in _LINKS.items():
        (folder / name).symlink_to(target)
    (folder / "hard.csv").hardlink_to(folder / "points.csv")
    (folder / "folder").mkdir()
    (folder / "locked.csv").write_text(_POINTS)
    (folder / "locked.csv").chmod(0)
    return {name: (folder / name).read_bytes() for name in _FILES}


def _examine(words: list[str], result: Any, given: dict[str, bytes], folder: Path) -> None:
    assert result.exit_code in (0, 1, 2), result.exit_code
    assert isinstance(result.exception, SystemExit | None), result.exception
    for word in ("Traceback", "A bug in tinsmith", "PosixPath", "np.float64", "NoneType"):
        assert word not in result.stderr, result.stderr
    written = {_real(folder, after) for before, after in pairwise(words) if before in _WRITING}
    read = {_real(folder, after) for before, after in pairwise(words) if before not in _WRITING}
    for name, content in given.items():
        is_free = _real(folder, name) in written - read
        assert is_free or (folder / name).read_bytes() == content, f"'{name}' was changed"
    hidden = [path.name for path in folder.rglob(".*")]
    assert not hidden, f"temporary files are left: {hidden}"
    if "--events" in (words[: words.index("--")] if "--" in words else words):
        _examine_events(result)
    elif result.exit_code == 1:
        assert result.stderr.splitlines()[-1].startswith("Error: "), result.stderr
    if _wants_json(words, result):
        json.loads(result.stdout)


def _examine_events(result: Any) -> None:
    """Require an object on every line, and the error as the last of them."""
    events = [json.loads(line) for line in result.stderr.splitlines()]
    assert {one["event"] for one in events} <= {"step", "summary", "warning", "error"}
    errors = [one["exit_code"] for one in events if one["event"] == "error"]
    assert errors == [result.exit_code] * (result.exit_code > 0), events
    assert not errors or events[-1]["event"] == "error"


def _real(folder: Path, word: str) -> str:
    return os.path.realpath(folder / word)


def _wants_json(words: list[str], result: Any) -> bool:
    """Whether --json is an option, and no value of the one before it."""
    options = words[: words.index("--")] if "--" in words else words
    alone = [word for before, word in pairwise(options) if before not in _WITH_VALUES]
    return "--json" in alone and "-" not in options and bool(result.stdout)


CAMPAIGNS = (Campaign("commands", "command lines of random options and paths", generate, examine),)
