"""Every product of a TIN that another thread edits meanwhile: each sees one state of it."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Event, Thread

import numpy as np
from support.product_calls import ALL, make_hill

import tinsmith as ts

from .campaign import Campaign, Case

_WRITTEN = (".ply", ".gpkg", ".obj", ".vtu", ".geojson")


def generate(rng: np.random.Generator) -> Case:
    """A product or a format, and what the editor does."""
    names = [name for name in ALL if name != "write"] + [f"write {end}" for end in _WRITTEN]
    return {
        "call": str(rng.choice(names)),
        "kind": str(rng.choice(["move", "insert and remove", "undo"])),
        "seed": int(rng.integers(2**31)),
    }


def examine(case: Case) -> str:
    """A few calls beside an editor: none fails, and what is written is sound."""
    tin = make_hill(321.0)
    stop = Event()
    editor = Thread(target=_edit, args=(tin, case, stop))
    editor.start()
    try:
        for _ in range(3):
            _call(tin, case["call"])
    finally:
        stop.set()
        editor.join()
    ts.check(tin).raise_if_failed()
    return case["call"].split()[0]


def _edit(tin: ts.TIN, case: Case, stop: Event) -> None:
    rng = np.random.default_rng(case["seed"])
    while not stop.is_set():
        place = [*(rng.random(2) * 90 + (700_002, 4_000_002)), float(320 + rng.random())]
        try:
            if case["kind"] == "move":
                tin.move(int(rng.integers(len(tin.points))), place)
            elif case["kind"] == "undo" and tin.edits and rng.random() < 0.4:
                tin.undo()
            elif rng.random() < 0.55:
                tin.insert([place])
            else:
                tin.remove(int(rng.integers(len(tin.points))))
        except ts.TinsmithError:
            pass  # a vertex that was removed meanwhile, a place that is taken


def _call(tin: ts.TIN, name: str) -> None:
    if not name.startswith("write"):
        ALL[name](tin)
        return
    with TemporaryDirectory() as folder:
        path = ts.write(tin, Path(folder, f"a{name.split()[1]}"))
        if path.suffix != ".geojson":
            ts.check(ts.read_tin(path), level=2).raise_if_failed()


CAMPAIGNS = (
    Campaign("snapshots", "products of a TIN that is edited meanwhile", generate, examine),
)
