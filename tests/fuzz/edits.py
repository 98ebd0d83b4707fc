"""Edit sequences: after every edit the TIN is the fresh build of the inputs that are there.

The inputs are tracked here, apart from the library: rows and lines as plain lists, changed as the
docstrings of the edits say. Which rows stand at a vertex is read off ``vertex_of``; which given
vertices of lines do, by their place.
"""

from __future__ import annotations

import copy
import pickle
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from support.point_sets import KINDS, coordinates

import tinsmith as ts
from tinsmith.tin.editing.history import apply_edits

from .campaign import Campaign, Case

ARRAYS = ("points", "triangles", "neighbors", "constrained")
CHAINS = ("vertices", "offsets", "kinds", "sources", "names")
POLICIES = ("last", "first", "mean", "lowest", "highest")
OPERATIONS = (
    "insert", "insert_old", "remove", "remove", "move", "set_elevation", "flip", "add_breakline",
    "add_breakline", "remove_breakline", "undo", "copy", "fork",
)  # fmt: skip
DESERVED = (
    "stands at", "goes with them", "stays at elevation", "would vanish", "No triangle",
    "all others are in line", "between two triangles", "which must stay", "convex",
    "lies outside the surface", "all its vertices at one place", "must hold",
)  # fmt: skip
"""Refusals that are no fresh build's."""


@dataclass
class Tracked:
    """The inputs: rows by their lasting numbers (None is removed), lines, options."""

    rows: list[list[float] | None]
    lines: list[dict[str, Any]]
    rings: dict[str, Any]
    options: dict[str, Any]
    before: list[Tracked] = field(default_factory=list)
    built: ts.TIN | None = None

    def build(self) -> ts.TIN:
        """Return the fresh build, made once; nothing edits it."""
        if self.built is None:
            self.built = self.build_anew()
        return self.built

    def build_anew(self) -> ts.TIN:
        """Return the fresh build."""
        there = [row for row in self.rows if row is not None]
        points = np.array(there, float).reshape(-1, 3)
        lines = [ts.Breakline(**line) for line in self.lines]
        rings = dict(self.rings)
        rings["water"] = [ts.Water(ring, 3.0) for ring in rings.get("water", [])]
        return ts.triangulate(points, breaklines=lines, **rings, **self.options)

    def changed(self) -> Tracked:
        """Return a copy to be changed; it remembers this one."""
        new = copy.deepcopy(Tracked(self.rows, self.lines, self.rings, self.options))
        new.before = [*self.before, self]
        return new

    def at(self, tin: ts.TIN, vertices: list[int]) -> list[int]:
        return np.flatnonzero(np.isin(tin.vertex_of, vertices)).tolist()

    def chains(self) -> list[list[list[float]]]:
        """All lists of vertices of lines and rings, to be changed in place."""
        return [line["coords"] for line in self.lines] + [
            ring for kind in ("boundary", "holes", "water") for ring in self.rings.get(kind, [])
        ]


# ------------------------------------------------------------------------ generate


def generate(rng: np.random.Generator) -> Case:
    """Make a TIN with or without lines and rings, and a list of edits."""
    kind = str(rng.choice([name for name in KINDS if name != "nearly_collinear"]))
    is_large = rng.random() < 0.1  # more is local there
    pool = coordinates(rng, 300 if is_large else 60, kind).tolist()

    def place() -> list[float]:
        return list(pool[rng.integers(len(pool))])

    def elevation() -> float:
        return float(rng.integers(-9, 10))

    def points(count: int) -> list[list[float]]:
        return [[*place(), elevation()] for _ in range(count)]

    def line() -> dict[str, Any]:
        is_draped = rng.random() < 0.25
        count = int(rng.integers(2, 5))
        return {
            "coords": [place() for _ in range(count)] if is_draped else points(count),
            "kind": str(rng.choice(["hard", "soft"])),
            "priority": int(rng.integers(0, 2)),
            "name": str(rng.choice(["", "kerb"])),
        }

    case: Case = {
        "rows": points(int(rng.integers(50, 150) if is_large else rng.integers(3, 25))),
        "lines": [line() for _ in range(rng.integers(0, 4) if rng.random() < 0.6 else 0)],
        "rings": {},
        "options": {},
    }
    if rng.random() < 0.15:
        kind_of_ring = str(rng.choice(["boundary", "holes", "erase", "water"]))
        case["rings"] = {kind_of_ring: [_corner_ring(np.array(pool))]}
    case["options"] = _options(rng, np.ptp(np.array(pool), axis=0).max())
    case["edits"] = [
        _edit(str(rng.choice(OPERATIONS)), rng, points, line)
        for _ in range(int(rng.integers(1, 15)))
    ]
    return case


def _corner_ring(xy: np.ndarray) -> list[list[float]]:
    """Return a rectangle over the upper right of the points."""
    low, high = xy.min(axis=0), xy.max(axis=0)
    (left, bottom), (right, top) = (low + (high - low) * 0.3).tolist(), high.tolist()
    return [[left, bottom], [right, bottom], [right, top], [left, top]]


def _options(rng: np.random.Generator, side: float) -> dict[str, Any]:
    options: dict[str, Any] = {}
    if rng.random() < 0.1:
        options["max_edge"] = float(side * rng.uniform(0.3, 1.0)) or 1.0
    if rng.random() < 0.1:
        options["snap"] = float(side * rng.choice([1e-3, 0.02, 0.1]))
    if rng.random() < 0.2:
        options["duplicates"] = str(rng.choice(["first", "last", "lowest", "error"]))
    return options


def _edit(operation: str, rng: np.random.Generator, points: Any, line: Any) -> dict[str, Any]:
    return {
        "op": operation,
        "at": [float(u) for u in rng.random(int(rng.integers(1, 3)))],
        "points": points(int(rng.integers(1, 4)) if rng.random() < 0.5 else 1),
        "line": line(),
        "policy": str(rng.choice(POLICIES)) if rng.random() < 0.5 else "last",
        "crossing": "error" if rng.random() < 0.1 else "split",
        "by": int(rng.integers(3)),
        "then": str(rng.choice([one for one in OPERATIONS if one not in ("copy", "fork")])),
    }


# ------------------------------------------------------------------------- examine


def examine(case: Case) -> str:
    """Do the edits, and compare with a fresh build after each of them."""
    tracked = Tracked(
        [[*map(float, row)] for row in case["rows"]], case["lines"], case["rings"], case["options"]
    )
    try:
        tin = tracked.build_anew()
    except ts.TinsmithError:
        return "refused at first"
    done = 0
    blind = Blind(tracked.build_anew(), tracked)
    for edit in case["edits"]:
        tin, tracked, is_done = _step(tin, tracked, edit, blind)
        done += is_done
    if done:
        ts.check(tin, level=3).raise_if_failed()
    blind.require_fresh()
    return "no edit" if done == 0 else "up to 4 edits" if done <= 4 else "5 edits and more"


@dataclass
class Blind:
    """A TIN that is edited alike, and not looked at before the end: edits are only logged."""

    tin: ts.TIN
    tracked: Tracked

    def follow(self, tracked: Tracked, new: Tracked, call: Any) -> None:
        """Do an edit that was done to another TIN of the same inputs."""
        if self.tracked is tracked:
            call(self.tin)
            self.tracked = new

    def require_fresh(self) -> None:
        """Look at it now, at its record, and at what is there when edits are taken back."""
        again = self.tracked
        first = again.before[0] if again.before else again
        require_fresh(self.tin, again, again.build())
        assert len(self.tin.edits) == len(again.before)
        replayed = first.build_anew()
        apply_edits(replayed, [edit.to_dict() for edit in self.tin.edits])
        require_same(replayed, again, self.tin)
        while again.before:
            count = (len(again.before) + 1) // 2
            self.tin.undo(count)
            again = again.before[-count]
            require_fresh(self.tin, again, again.build())


def _step(
    tin: ts.TIN, tracked: Tracked, edit: dict[str, Any], blind: Blind | None = None
) -> tuple[ts.TIN, Tracked, bool]:
    if edit["op"] == "copy":
        return _copied(tin, tracked, edit["by"]), tracked, False
    if edit["op"] == "fork":
        return _forked(tin, tracked, edit)
    if edit["op"] == "undo":
        return _undone(tin, tracked, len(edit["at"]))
    wanted = _prepare(tin, tracked, edit)
    if wanted is None:
        return tin, tracked, False
    new, call = wanted
    keep = copy.copy(tin)
    try:
        call(tin)
    except ts.TinsmithError as error:
        _require_deserved(error, new, edit)
        require_same(tin, tracked, keep)
        return tin, tracked, False
    require_fresh(tin, new, new.build())
    require_fresh(keep, tracked, tracked.build())
    if blind is not None:
        blind.follow(tracked, new, call)
    return tin, new, True


def _require_deserved(error: ts.TinsmithError, new: Tracked, edit: dict[str, Any]) -> None:
    if any(words in str(error) for words in DESERVED) or edit["crossing"] == "error":
        return
    try:
        new.build()
    except ts.TinsmithError:
        return
    raise AssertionError(f"{edit['op']} was refused, but a fresh build takes it: {error}")


def _copied(tin: ts.TIN, tracked: Tracked, by: int) -> ts.TIN:
    other = [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))][by](tin)
    require_same(other, tracked, tin)
    return other


def _forked(tin: ts.TIN, tracked: Tracked, edit: dict[str, Any]) -> tuple[ts.TIN, Tracked, bool]:
    """Edit a copy, then its original by itself; go on with either."""
    other = _copied(tin, tracked, edit["by"])
    first = _step(other, tracked, {**edit, "op": edit["then"]})
    require_fresh(tin, tracked, tracked.build())
    second = _step(tin, tracked, {**edit, "op": "set_elevation"})
    require_fresh(first[0], first[1], first[1].build())
    return first if len(edit["at"]) == 1 else second


def _undone(tin: ts.TIN, tracked: Tracked, count: int) -> tuple[ts.TIN, Tracked, bool]:
    count = min(count, len(tracked.before))
    if count == 0:
        return tin, tracked, False
    tin.undo(count)
    tracked = tracked.before[-count]
    require_fresh(tin, tracked, tracked.build())
    assert len(tin.edits) == len(tracked.before)
    return tin, tracked, True


def _prepare(tin: ts.TIN, tracked: Tracked, edit: dict[str, Any]) -> Any:
    """Return the inputs after an edit, and what does it."""
    new = tracked.changed()
    vertices = list(dict.fromkeys(int(u * len(tin.points)) for u in edit["at"]))
    operation = edit["op"].removesuffix("_old")
    if new.options.get("snap") and operation in (
        "remove",
        "move",
        "set_elevation",
        "flip",
        "insert",
    ):
        return None if operation != "insert" else _insert_apart(tin, new, edit)
    if operation == "insert":
        points = [list(point) for point in edit["points"]]
        if edit["op"] == "insert_old":
            points[0][:2] = tin.points[vertices[0], :2].tolist()
        return _insert(tin, new, points, edit["policy"])
    if operation == "add_breakline":
        new.lines.append(edit["line"])
        arguments = {**edit["line"], "crossing": edit["crossing"]}
        return new, lambda one: one.add_breakline(**arguments)
    if operation == "remove_breakline":
        if not new.lines:
            return None
        number = int(edit["at"][0] * len(new.lines))
        del new.lines[number]
        return new, lambda one: one.remove_breakline(number)
    return {"remove": _remove, "move": _move, "set_elevation": _set_elevation, "flip": _flip}[
        operation
    ](tin, new, vertices, edit)


def _insert_apart(tin: ts.TIN, new: Tracked, edit: dict[str, Any]) -> Any:
    points = edit["points"]
    at = [[*p[:2]] for p in points] + tin.points[:, :2].tolist()
    if len({tuple(p) for p in at}) < len(at):
        return None
    new.rows += points
    return new, lambda one: one.insert(points, duplicates=edit["policy"])


def _insert(tin: ts.TIN, new: Tracked, points: list[list[float]], policy: str) -> Any:
    own = {tuple(p[:2]): (v, p[2]) for v, p in enumerate(tin.points.tolist())}
    here = {place: z for place, (_, z) in own.items()}
    counts: dict[tuple[float, ...], int] = {}
    for x, y, z in points:
        old = here.get((x, y))
        counts[x, y] = counts.get((x, y), 0) + 1
        if old is not None:
            z = {"last": z, "first": old, "lowest": min(z, old), "highest": max(z, old),
                 "mean": min(z, old) + abs(z - old) / 2}[policy]  # fmt: skip
        here[x, y] = z
    for place in counts:
        if place in own:
            _lift(tin, new, own[place][0], here[place])
    new.rows += [[x, y, here[x, y]] for x, y, _ in points]
    return new, lambda one: one.insert(points, duplicates=policy)


def _lift(tin: ts.TIN, new: Tracked, vertex: int, z: float) -> bool:
    """Give the rows and line vertices at a vertex an elevation; tell whether there are any."""
    found = False
    for row in new.at(tin, [vertex]):
        new.rows[row][2] = z
        found = True
    for chain in new.chains():
        for point in chain:
            if len(point) == 3 and point[:2] == tin.points[vertex, :2].tolist():
                point[2] = z
                found = True
    shores = [corner for ring in new.rings.get("water", []) for corner in ring]
    return found or tin.points[vertex, :2].tolist() in shores


def _remove(tin: ts.TIN, new: Tracked, vertices: list[int], edit: dict[str, Any]) -> Any:
    places = tin.points[vertices, :2].tolist()
    for row in new.at(tin, vertices):
        new.rows[row] = None
    for line in new.lines:
        line["coords"] = _without(line["coords"], places, can_close=True)
    for kind in ("boundary", "holes", "water"):
        rings = new.rings.get(kind, [])
        new.rings |= {kind: [_without(r, places, can_close=False) for r in rings]} if rings else {}
    given = vertices[0] if len(vertices) == 1 else vertices
    return new, lambda one: one.remove(given)


def _without(chain: list[list[float]], places: list[list[float]], *, can_close: bool) -> Any:
    is_closed = can_close and chain[0][:2] == chain[-1][:2]
    rest = [point for point in chain if point[:2] not in places]
    if is_closed and chain[0][:2] in places and rest:
        rest.append(list(rest[0]))
    return rest


def _move(tin: ts.TIN, new: Tracked, vertices: list[int], edit: dict[str, Any]) -> Any:
    vertex, point = vertices[0], edit["points"][0]
    place = tin.points[vertex, :2].tolist()
    for row in new.at(tin, [vertex]):
        new.rows[row] = list(point)
    for chain in new.chains():
        for own in chain:
            if own[:2] == place:
                own[:] = point[: len(own)]
    return new, lambda one: one.move(vertex, point)


def _set_elevation(tin: ts.TIN, new: Tracked, vertices: list[int], edit: dict[str, Any]) -> Any:
    z = edit["points"][0][2]
    made = [vertex for vertex in sorted(vertices) if not _lift(tin, new, vertex, z)]
    new.rows += [[*tin.points[vertex, :2].tolist(), z] for vertex in made]
    given = vertices[0] if len(vertices) == 1 else vertices
    return new, lambda one: one.set_elevation(given, z)


def _flip(tin: ts.TIN, new: Tracked, vertices: list[int], edit: dict[str, Any]) -> Any:
    a, b = tin.edges[int(edit["at"][0] * len(tin.edges))].tolist()
    beside = [t for t in tin.triangles.tolist() if a in t and b in t]
    own = [
        int(source)
        for chain, source, name in zip(
            tin.lines.chains(), tin.lines.sources, tin.lines.names, strict=True
        )
        if any(
            {a, b} == set(step) for step in zip(chain.tolist(), chain.tolist()[1:], strict=False)
        )
        and name == "flip"
    ]
    if own:
        new.lines = [line for number, line in enumerate(new.lines) if number not in own]
    elif len(beside) == 2:
        beside.sort(key=lambda t: t[(t.index(a) + 1) % 3] != b)  # the left one first
        ends = [v for t in beside for v in t if v not in (a, b)]
        line = {"coords": tin.points[ends].tolist(), "kind": "soft", "name": "flip"}
        new.lines.append(line)
    return new, lambda one: one.flip(a, b)


# ------------------------------------------------------------------------- compare


def require_fresh(tin: ts.TIN, tracked: Tracked, fresh: ts.TIN) -> None:
    """Compare everything with the build of the inputs."""
    for name in ARRAYS:
        _require_equal(name, getattr(tin, name), getattr(fresh, name))
    for name in CHAINS:
        _require_equal(f"lines.{name}", getattr(tin.lines, name), getattr(fresh.lines, name))
    there = np.array([n for n, row in enumerate(tracked.rows) if row is not None], int)
    vertex_of = np.full(len(tracked.rows), -1)
    vertex_of[there] = fresh.vertex_of
    _require_equal("vertex_of", tin.vertex_of, vertex_of)
    _require_same_report(tin.report, fresh.report, there)


def _require_same_report(found: ts.Report, fresh: ts.Report, there: Any) -> None:
    for group in ("crossings", "overruled"):
        for name, own, wanted in zip(
            getattr(found, group)._fields, getattr(found, group), getattr(fresh, group), strict=True
        ):
            _require_equal(f"{group}.{name}", own, wanted)
    wanted_merges = [m._replace(rows=tuple(there[list(m.rows)].tolist())) for m in fresh.merges()]
    assert list(found.merges()) == wanted_merges, "merges"
    assert (found.n_vertices, found.n_triangles) == (fresh.n_vertices, fresh.n_triangles)
    assert (found.n_lines, found.line_labels) == (fresh.n_lines, fresh.line_labels)
    assert tuple(found.notes) == tuple(fresh.notes)
    own, wanted = found.to_dict()["left_out"], fresh.to_dict()["left_out"]
    own.pop("removed by an edit", None)
    assert own == {why: there[rows].tolist() for why, rows in wanted.items()}, "left_out"


def require_same(tin: ts.TIN, tracked: Tracked, other: ts.TIN) -> None:
    """Compare everything with a TIN of the same history."""
    require_fresh(tin, tracked, tracked.build())
    for name in (*ARRAYS, "vertex_of"):
        _require_equal(name, getattr(tin, name), getattr(other, name))
    assert tin.report.to_dict() == other.report.to_dict(), "report"


def _require_equal(name: str, found: Any, wanted: Any) -> None:
    found, wanted = np.asarray(found), np.asarray(wanted)
    is_equal = np.array_equal(found, wanted, equal_nan=found.dtype.kind == "f")
    assert is_equal, f"{name}: {found.tolist()} is not {wanted.tolist()}"


CAMPAIGNS = (Campaign("edits", "edit sequences against a fresh build", generate, examine),)
