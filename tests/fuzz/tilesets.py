"""Random tilesets in the page: what is shown covers what is in view, once, and is fine enough."""

from __future__ import annotations

import functools
import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from support.pages import open_page, wait_until
from support.tilesets import make_square_glb, make_tile, write_tileset

import tinsmith as ts

from .campaign import Campaign, Case

_SIDE = 256.0
_MOST_ERROR = 3.0
_PATIENCE = 20_000
_FEED = """async (files) => {
  const input = document.getElementById("folder"), data = new DataTransfer();
  for (const [path, text] of Object.entries(files)) {
    const file = new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], path);
    Object.defineProperty(file, "webkitRelativePath", { value: path });
    data.items.add(file);
  }
  Object.defineProperty(input, "files", { value: [...data.files], configurable: true });
  input.dispatchEvent(new Event("change"));
}"""
_OPENED = """!document.getElementById("wait")
  || document.getElementById("wait").innerText.includes("cannot")"""
_STATE = """async () => { const p = await window.terrain, t = p.tileset;
  await t.settle(); await t.settle();
  const box = (one) => [...one.low, ...one.high];
  const walk = (one) => ({ contents: one.contents, home: one.home, state: one.state,
    error: one.error, box: box(one), replaced: one.isReplaced,
    isShown: t.choice.shown.includes(one), children: one.children.map(walk) });
  const c = p.scene.camera;
  c.updateMatrixWorld();
  return { root: walk(t.root), lift: p.scene.lift, eye: c.position.toArray(),
    height: p.scene.canvas.clientHeight, projection: c.projectionMatrix.elements,
    view: c.matrixWorldInverse.elements, failures: t.failures.length, bytes: t.bytes,
    parts: t.surface.parts.length, drawn: t.group.children.length }; }"""


def generate(rng: np.random.Generator) -> Case:
    """A tree of squares, deep here and shallow there, some of it missing, and views of it."""
    budget = [int(rng.integers(1, 40))]
    share = {
        name: float(rng.choice([0.0, 0.0, 0.2])) for name in ("empty", "missing", "add", "outside")
    }

    def grow(level: int, low: list[float], width: float) -> dict[str, Any]:
        budget[0] -= 1
        kinds = {name: bool(rng.random() < one) for name, one in share.items()}
        tile: dict[str, Any] = {"low": low, "width": width, **kinds, "children": []}
        if level == 0:
            tile["missing"] = tile["outside"] = False
        for i in (0, 1):
            for j in (0, 1):
                if level < 4 and budget[0] > 0 and rng.random() < (0.9 if level == 0 else 0.55):
                    at = [low[0] + i * width / 2, low[1] + j * width / 2]
                    tile["children"].append(grow(level + 1, at, width / 2))
        tile["empty"] = tile["empty"] and bool(tile["children"])
        tile["error"] = float(width / 16 * rng.choice([0.2, 1.0, 3.0])) if tile["children"] else 0.0
        return tile

    root = grow(0, [-_SIDE / 2, -_SIDE / 2], _SIDE)
    low, high = [0.5, -0.6, -0.6, 0.0, 2.0], [2.5, 0.6, 0.6, 360.0, 90.0]
    moves = rng.uniform(low, high, (3, 5)).tolist()
    small = bool(rng.random() < 0.25)
    return {"root": root, "moves": moves, "bytes": 12_000 if small else None}


def examine(case: Case) -> str:
    """Look from several places; hold what is shown against the tree and the camera."""
    with tempfile.TemporaryDirectory() as folder:
        files = write(case["root"], Path(folder))
    page = _open()
    page.reload()
    page.wait_for_selector("#folder")
    page.evaluate(_FEED, files)
    wait_until(page, _OPENED)
    if page.query_selector("#wait") is not None:
        words = page.inner_text("#wait")
        assert not holds_contents(case["root"]), words
        return "refused"
    if case["bytes"] is not None:
        page.evaluate(f"window.terrain.then((p) => {{ p.tileset.mostBytes = {case['bytes']}; }})")
    seen = set()
    for zoom, right, ahead, azimuth, tilt in case["moves"]:
        page.evaluate(
            f"window.terrain.then((p) => {{ p.scene.look({azimuth}, {tilt}); p.scene.zoom({zoom});"
            f" p.scene.move({right}, {ahead}); p.scene.draw(); }})"
        )
        for _ in range(1 if case["bytes"] is None else 8):
            state = page.evaluate(_STATE)
        is_exact = case["bytes"] is None
        seen.add(check(state, is_exact=is_exact))
    return " and ".join(sorted(seen))


def holds_contents(tile: dict[str, Any]) -> bool:
    """Tell whether anything of a tree can be shown."""
    has = not tile["empty"] and not tile["missing"]
    return has or any(map(holds_contents, tile["children"]))


def write(root: dict[str, Any], folder: Path) -> dict[str, str]:
    """Write a tileset; return its files by paths, in base64."""
    import base64

    contents: dict[str, bytes] = {}

    def make(tile: dict[str, Any], name: str) -> dict[str, Any]:
        low, width = tile["low"], tile["width"]
        high = [one + width for one in low]
        uri = None if tile["empty"] else f"c/{name}.glb"
        if uri is not None and not tile["missing"]:
            contents[uri] = make_square_glb(low, high, cells=3)
        children = [make(one, f"{name}{k}") for k, one in enumerate(tile["children"])]
        more = {"refine": "ADD" if tile["add"] else "REPLACE"}
        made = make_tile(low, high, tile["error"], uri=uri, children=children, relief=6.0, **more)
        if not tile["outside"]:
            return made
        write_tileset(folder, made, {}, name=f"{name}.json")
        inner = json.loads((folder / f"{name}.json").read_text().replace('"c/', '"./c/'))
        (folder / f"{name}.json").write_text(json.dumps(inner))
        return make_tile(low, high, tile["error"], uri=f"{name}.json", relief=6.0)

    write_tileset(folder, make(root, "t"), contents)
    return {
        f"x/{path.relative_to(folder).as_posix()}": base64.b64encode(path.read_bytes()).decode()
        for path in folder.rglob("*")
        if path.is_file()
    }


def check(state: dict[str, Any], *, is_exact: bool) -> str:
    """Hold what is shown against the rules, by the plainest way there is."""
    assert state["drawn"] >= state["parts"] == len(list_shown(state["root"]))
    measure = functools.partial(measure_tile, state)
    wanted: set[int] = set()
    choose(state["root"], measure, wanted)
    shown = list_shown(state["root"])
    if is_exact:
        assert {id(one) for one in shown} == wanted, "other tiles are shown than are to be"
    require_once(state["root"], measure, above=False)
    failed = state["failures"] > 0
    if not failed and measure(state["root"]) is not None:
        require_cover(state["root"], measure)
    return "failures" if failed else "out of view" if not shown else "shown"


def list_shown(tile: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the tiles that are shown."""
    below = [one for child in tile["children"] for one in list_shown(child)]
    return [tile, *below] if tile["isShown"] else below


def measure_tile(state: dict[str, Any], tile: dict[str, Any]) -> float | None:
    """Return the error in pixels, or None out of view: outside one of the planes."""
    low, high = np.array(tile["box"][:3]), np.array(tile["box"][3:])
    scale = np.array([1.0, 1.0, state["lift"]])
    low, high = low * scale, high * scale
    corners = np.array([[a, b, c, 1.0] for a in (low[0], high[0]) for b in (low[1], high[1])
                        for c in (low[2], high[2])])  # fmt: skip
    matrix = np.reshape(state["projection"], (4, 4)).T @ np.reshape(state["view"], (4, 4)).T
    x, y, z, w = matrix @ corners.T
    if any(
        (side < -1e-9 * np.abs(w).max()).all()
        for side in (w - x, w + x, w - y, w + y, w - z, w + z)
    ):
        return None
    eye = np.array(state["eye"])
    away = float(np.linalg.norm(eye - np.clip(eye, low, high)))
    per_slope = state["height"] / (2 * np.tan(np.radians(15.0)))
    error = tile["error"] * max(1.0, state["lift"]) * per_slope
    return np.inf if away == 0.0 and error > 0 else error / away if away else 0.0


def choose(tile: dict[str, Any], measure: Any, shown: set[int]) -> bool:
    """Gather what is to be shown once all files were asked for; tell whether a tile is covered."""
    error = measure(tile)
    if error is None:
        return True
    has = tile["state"] == "ready"
    if tile["state"] == "failed" and not tile["children"]:
        return False
    below: set[int] = set()
    covered = [choose(child, measure, below) for child in tile["children"]]
    is_fine = has and (error <= _MOST_ERROR or not tile["children"])
    if has and not tile["replaced"]:
        shown |= {id(tile)} | (set() if is_fine else below)
        return True
    if is_fine or (has and not all(covered)):
        shown.add(id(tile))
        return True
    shown |= below
    return all(covered)


def require_once(tile: dict[str, Any], measure: Any, *, above: bool) -> None:
    """Refuse a tile under another that it is to stand in place of."""
    assert not (above and tile["isShown"]), "a tile and one above it are shown"
    for child in tile["children"]:
        require_once(child, measure, above=above or (tile["isShown"] and tile["replaced"]))


def require_cover(tile: dict[str, Any], measure: Any) -> None:
    """Refuse a place in view, of a tree without failures, on which nothing is shown."""
    if measure(tile) is None or tile["isShown"]:
        return
    if not tile["children"]:
        assert tile["state"] == "empty" or not tile["contents"], "a hole"
    for child in tile["children"]:
        require_cover(child, measure)


@functools.cache
def _open() -> Any:
    """Open a page of some tileset, which waits for a folder; a process has one."""
    folder = Path(tempfile.mkdtemp())
    write_tileset(folder, make_tile((0, 0), (1, 1), 0.0, uri="a.glb"), {})
    path = ts.preview_tileset(folder, output=folder / "index.html")
    keep = open_page(path, ready="Promise.resolve(1)", viewport={"width": 700, "height": 500})
    page = keep.__enter__()
    page.set_default_timeout(_PATIENCE)
    page.keep = keep
    return page


CAMPAIGNS = (
    Campaign(
        "tilesets",
        "random tilesets in the page",
        generate,
        examine,
        seconds=120.0,
        megabytes=2**30,  # a browser reserves addresses that it never fills
        weight=20,
    ),
)
