"""Campaign: runs over many files that are killed, and go on to the same bytes."""

from __future__ import annotations

import filecmp
import json
import os
import signal
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
from support.many_files import Shuffled
from support.sources_in_place import write_octree

import tinsmith as ts

from .campaign import Campaign, Case

CRS = "EPSG:32616"
VICTIMS = ("group", "group", "parent", "worker")
_POLL = 0.001
_PATIENCE = 400.0
_NAME_OF_GROUP = 2
"""Field of the process group in /proc/PID/stat, behind the name of the program."""


class Product(NamedTuple):
    """What a run writes: where, and how."""

    name: str
    write: Callable[..., Path]


def _cut(cloud: ts.TiledPoints, path: Path, **way: Any) -> Path:
    bounds = cloud.bounds
    assert bounds is not None
    corners = np.add([[1.0, 2.0], [90.0, 70.0]], [bounds.xmin, bounds.ymin])
    return cloud.profile(path, corners, **way)


def _classify(cloud: ts.TiledPoints, path: Path, **way: Any) -> Path:
    return cloud.ground(path.parent / "ground", building=10.0, **way)


PRODUCTS = {
    "raster": Product("out.tif", lambda c, path, **way: c.rasterize(path, spacing=0.5, **way)),
    "cog": Product(
        "out.tif", lambda c, path, **way: c.rasterize(path, spacing=0.5, format="cog", **way)
    ),
    "contours": Product("out.gpkg", lambda c, path, **way: c.contours(path, 1.0, **way)),
    "bands": Product("out.fgb", lambda c, path, **way: c.contours(path, 2.0, bands=True, **way)),
    "volume": Product("out.csv", lambda c, path, **way: c.volume(path, base=10.0, **way)),
    "profile": Product("out.csv", _cut),
    "surface": Product("out", lambda c, path, **way: c.build(path, **way)),
    "3dtiles": Product("out", lambda c, path, **way: c.write(path, node_points=500, **way)),
    "ground": Product("ground", _classify),
}


def generate(rng: np.random.Generator) -> Case:
    """A product, and when its run is killed: at so many files of the run, or while it is joined."""
    kills = [
        {
            "at": "joining" if rng.random() < 0.25 else int(rng.integers(0, 45)),
            "delay": float(rng.random() * 0.05),
            "victim": str(rng.choice(VICTIMS)),
        }
        for _ in range(int(rng.integers(1, 4)))
    ]
    return {
        "product": str(rng.choice(list(PRODUCTS))),
        "seed": int(rng.integers(0, 10**6)),
        "tiles": int(rng.integers(2, 17)),
        "kills": kills,
        "in_place": bool(rng.random() < 0.4),
    }


def examine(case: Case) -> str:
    """Kill a run again and again, then let it end; compare it with one that nobody killed."""
    with TemporaryDirectory() as name:
        folder = Path(name).resolve()
        for one in ("inputs", "tmp", "whole", "killed"):
            (folder / one).mkdir()
        is_there = bool(case.get("in_place")) and case["product"] != "ground"
        if is_there:  # an octree: GDAL, once used, does not work in processes that are forked
            write_octree(folder / "inputs" / "all.copc.laz", 3_000, seed=case["seed"])
        else:
            _write_inputs(folder / "inputs", case["seed"])
        product = PRODUCTS[case["product"]]
        asked = {"tiles": case["tiles"], "in_place": is_there}
        alone = _start(product, folder, "whole", asked | {"executor": Shuffled(case["seed"])})
        _require_ended(alone, folder)
        killed = 0
        for kill in case["kills"]:
            process = _start(product, folder, "killed", asked | {"workers": 2})
            killed += _kill(process, kill, folder / "killed")
            _require_no_processes(process)
        again = _start(product, folder, "killed", asked | {"workers": 2})
        _require_ended(again, folder)
        _require_no_processes(again)
        _require_same(folder / "whole", folder / "killed")
        left = [one.name for one in (folder / "tmp").iterdir()]
        assert left == [], f"temporary files were left: {left}"
    return f"killed {killed} times"


def _write_inputs(folder: Path, seed: int) -> None:
    rng = np.random.default_rng(seed)
    xy = rng.random((3_000, 2)) * [100, 80]
    z = 10 + 4 * np.sin(xy[:, 0] / 15) + rng.normal(0, 0.05, len(xy))
    points = np.round(np.column_stack([np.add(xy, [500_000, 4_000_000]), z]), 2)
    for k in range(3):
        ts.write(ts.Survey(points=points[k::3], crs=CRS), folder / f"part{k}.laz")


def _start(product: Product, folder: Path, name: str, way: dict[str, Any]) -> int:
    """Start a run in a process group of its own; what is raised lies in a file afterwards."""
    in_place = way.pop("in_place")
    process = os.fork()
    if process:
        return process
    code = 1
    try:
        os.setsid()
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        os.environ["TMPDIR"] = tempfile.tempdir = str(folder / "tmp")
        warnings.simplefilter("ignore")
        cloud = ts.tiles(folder / "inputs", in_place=in_place)
        assert bool(cloud.plan().in_place) == in_place
        product.write(cloud, folder / name / product.name, **way)
        code = 0
    except BaseException:
        (folder / "error.txt").write_text(traceback.format_exc(), encoding="utf-8")
    finally:
        os._exit(code)


def _kill(process: int, kill: dict[str, Any], folder: Path) -> bool:
    """Kill a run when its moment has come; tell whether it had not ended by itself."""
    patience = time.monotonic() + _PATIENCE
    while not _has_come(kill["at"], folder):
        if os.waitpid(process, os.WNOHANG)[0]:
            return False
        assert time.monotonic() < patience, "the run hangs"
        time.sleep(_POLL)
    time.sleep(kill["delay"])
    if kill["victim"] == "worker":
        workers = [one for one in _list_group(process) if one != process]
        for one in workers[-1:]:
            _send_kill(os.kill, one)
        os.waitpid(process, 0)
        return bool(workers)
    _send_kill(os.killpg if kill["victim"] == "group" else os.kill, process)
    return os.WIFSIGNALED(os.waitpid(process, 0)[1])


def _send_kill(send: Callable[[int, int], None], process: int) -> None:
    try:
        send(process, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):  # before it has a group, or after its end
        os.kill(process, signal.SIGKILL)


def _has_come(at: int | str, folder: Path) -> bool:
    if at == "joining":
        return any(one.name.startswith(".") for one in folder.iterdir())
    return sum(len(here) + len(files) for _, here, files in os.walk(folder)) >= int(at)


def _require_ended(process: int, folder: Path) -> None:
    patience = time.monotonic() + _PATIENCE
    while True:
        ended, status = os.waitpid(process, os.WNOHANG)
        if ended:
            break
        if time.monotonic() > patience:
            os.killpg(process, signal.SIGKILL)
            raise AssertionError("the run hangs")
        time.sleep(_POLL)
    if status:
        raise AssertionError((folder / "error.txt").read_text(encoding="utf-8"))


def _require_no_processes(group: int) -> None:
    """Require that no process of a run is left, when those that see its end have had time to."""
    patience = time.monotonic() + _PATIENCE
    while left := list(_list_group(group)):
        if time.monotonic() > patience:
            os.killpg(group, signal.SIGKILL)
            raise AssertionError(f"{len(left)} processes were left")
        time.sleep(_POLL)


def _list_group(group: int) -> Iterator[int]:
    """Yield the processes of a group that have not ended."""
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, *fields = path.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[_NAME_OF_GROUP - 1]) == group and state != "Z":
            yield int(path.parent.name)


def _require_same(whole: Path, killed: Path) -> None:
    """Require the same files with the same bytes, and nothing else."""
    files, others = (
        sorted(str(one.relative_to(folder)) for one in folder.rglob("*"))
        for folder in (whole, killed)
    )
    assert files == others, json.dumps([files, others])
    for name in files:
        if (whole / name).is_file():
            assert filecmp.cmp(whole / name, killed / name, shallow=False), name


CAMPAIGNS = (
    Campaign(
        "kills",
        "runs over many files that are killed and go on",
        generate,
        examine,
        seconds=1800.0,
        weight=100,
    ),
)
