"""How well and how fast the ground is found: labelled samples, beside other filters.

``python -m benchmarks.ground FOLDER`` prints the table of docs/ground.md for the LAS and LAZ files
of a folder whose class 2 is ground, such as the ISPRS filter test (Sithole and Vosselman, "Report:
ISPRS comparison of filters", 2003). ``--changed`` prints the errors on the same files turned,
thinned and cut, ``--leave-one-out N`` those with the best of N random sets of parameters, chosen
for each file by the others. ``--points N`` times N points of a terrain that is made, with houses,
trees and low noise. ``--reach N`` prints how many labels of N such points differ in tiles that look
at the points up to some distance around them, from those of all points at once.

Each filter has one set of parameters for all files: its own defaults, for CSF those that its paper
gives for steep slopes with post-processing.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import tinsmith as ts
from tinsmith.terrain.ground_filter import Frame, Parameters, Units
from tinsmith.terrain.parts import are_owned
from tinsmith.terrain.parts.ground import GroundWindow, choose_reach
from tinsmith.tin.tiling import are_in_box

from .measure import is_installed
from .report.tables import TEXT, Table, add_option

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tinsmith.base.arrays import BoolArray, Float64Array, Int64Array

    Filter = Callable[[ts.Survey], BoolArray]
    Changed = tuple[Float64Array, Int64Array]
    Change = Callable[[Float64Array, np.random.Generator], Changed]

GROUND = 2


class Errors(NamedTuple):
    """Percentages: ground that was missed, others taken, both of all points, Cohen's kappa."""

    type_i: float
    type_ii: float
    total: float
    kappa: float


def measure_errors(found: BoolArray, truth: BoolArray) -> Errors:
    """Compare what a filter found with the labels."""
    missed, wrong = (truth & ~found).sum(), (~truth & found).sum()
    agreed = 1 - (missed + wrong) / len(truth)
    chance = truth.mean() * found.mean() + (~truth).mean() * (~found).mean()
    return Errors(
        100 * missed / truth.sum(),
        100 * wrong / (~truth).sum(),
        100 * (1 - agreed),
        100 * (agreed - chance) / (1 - chance),
    )


# --------------------------------------------------------------------------------- filters


def find_by_tinsmith(survey: ts.Survey) -> BoolArray:
    """Densify a TIN."""
    bare = ts.Survey(points=survey.points, crs=survey.crs)
    return ts.ground(bare).is_ground


def find_by_cloth(survey: ts.Survey) -> BoolArray:
    """Let a cloth fall on the points upside down."""
    import CSF

    cloth = CSF.CSF()
    cloth.params.bSloopSmooth = True
    cloth.params.rigidness = 1
    cloth.params.cloth_resolution = 1.0
    cloth.params.class_threshold = 0.5
    cloth.setPointCloud(survey.points)
    ground, others = CSF.VecInt(), CSF.VecInt()
    with _silence(), _in_folder():  # it prints, and may write a file where it is
        cloth.do_filtering(ground, others)
    found = np.zeros(len(survey), bool)
    found[np.array(ground)] = True
    return found


def find_by_whitebox(survey: ts.Survey) -> BoolArray:
    """Classify with the improved ground point filter of Whitebox Workflows, through files."""
    import whitebox_workflows

    environment = whitebox_workflows.WbEnvironment()
    with _silence(), _in_folder() as folder:
        bare = ts.Survey(points=survey.points, crs=survey.crs)
        given = ts.write(bare, folder / "given.las")
        classify = environment.lidar.filtering_classification.improved_ground_point_filter
        classify(input=str(given), classify=True, output=str(folder / "found.las"))
        found = ts.read(folder / "found.las")
    if len(found) != len(survey):
        raise ValueError("the filter has left points out")
    return np.equal(found.attributes["classification"], GROUND)


FILTERS: dict[str, tuple[str, Filter]] = {
    "tinsmith": ("tinsmith", find_by_tinsmith),
    "CSF": ("CSF", find_by_cloth),
    "Whitebox": ("whitebox_workflows", find_by_whitebox),
}


# --------------------------------------------------------------------------------- changes


def _turn(degrees: float) -> Change:
    cosine, sine = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    matrix = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
    return lambda points, _: (points @ matrix.T, np.arange(len(points)))


def _thin(share: float) -> Change:
    def change(points: Float64Array, rng: np.random.Generator) -> Changed:
        rows = np.flatnonzero(rng.uniform(size=len(points)) < share)
        return points[rows], rows

    return change


def _cut(west: float, south: float) -> Change:
    def change(points: Float64Array, _: np.random.Generator) -> Changed:
        rows = np.flatnonzero((points[:, :2] > (west, south)).all(axis=1))
        return points[rows], rows

    return change


CHANGES = {
    "as they are": _turn(0),
    "turned by 17°": _turn(17),
    "turned by 30°": _turn(30),
    "turned by 45°": _turn(45),
    "turned by 71°": _turn(71),
    "half of them": _thin(0.5),
    "a quarter of them": _thin(0.25),
    "cells moved by 0.3 m": _cut(0.3, 0.3),
    "cells moved by 0.75 and 0.5 m": _cut(0.75, 0.5),
}

RANGES = {
    "building": (36.0, 60.0),
    "cell": (0.75, 1.5),
    "terrain_slope": (0.08, 0.22),
    "iteration_angle": (12.0, 28.0),
    "iteration_distance": (0.8, 2.0),
    "edge_length": (3.0, 8.0),
    "tolerance": (0.2, 0.4),
    "horizontal_tolerance": (0.4, 1.3),
}
"""Of parameters that are drawn."""


@contextmanager
def _silence() -> Iterator[None]:
    """Send what libraries print to standard output nowhere."""
    sys.stdout.flush()
    kept = os.dup(1)
    with Path(os.devnull).open("w", encoding="utf-8") as nowhere:
        os.dup2(nowhere.fileno(), 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)


@contextmanager
def _in_folder() -> Iterator[Path]:
    here = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            yield Path(folder)
        finally:
            os.chdir(here)


# ---------------------------------------------------------------------------------- tables


def compare_filters(folder: Path) -> Table:
    """Show the errors of every filter on every file."""
    files = _list_files(folder)
    tools = {name: find for name, (module, find) in FILTERS.items() if is_installed(module)}
    table = Table(
        {"file": TEXT, "points": "{:,}"}
        | dict.fromkeys(("type I", "type II", "total", "kappa"), "{:.2f}")
        | {f"{name}: total, kappa": "{:.2f}, {:.1f}" for name in list(tools)[1:]}
    )
    rows: list[list[Errors]] = []
    for path in files:
        survey = ts.read(path)
        truth = np.equal(survey.attributes["classification"], GROUND)
        errors = [measure_errors(find(survey), truth) for find in tools.values()]
        rows.append(errors)
        table.show(path.name, len(survey), *_list_cells(errors))
    means = [Errors(*one) for one in np.mean(rows, axis=0).tolist()]
    table.show("**mean**", None, *_list_cells(means))
    return table


def change_points(folder: Path) -> Table:
    """Show the mean total error on the files turned, thinned and cut."""
    samples = _read_samples(folder)
    table = Table({"points": TEXT, "mean total": "{:.2f}"})
    for name, change in CHANGES.items():
        totals = []
        for number, (points, truth) in enumerate(samples):
            changed, rows = change(points, np.random.default_rng(number))
            totals.append(measure_errors(ts.ground(changed).is_ground, truth[rows]).total)
        table.show(name, float(np.mean(totals)))
    return table


def print_leave_one_out(folder: Path, count: int) -> None:
    """Print the mean total error with parameters chosen for each file by the others."""
    samples = _read_samples(folder)
    rng = np.random.default_rng(1)
    totals = np.empty((count, len(samples)))
    for row in totals:
        chosen = {name: rng.uniform(*ends) for name, ends in RANGES.items()}
        found = [ts.ground(points, **chosen).is_ground for points, _ in samples]
        row[:] = [
            measure_errors(is_ground, truth).total
            for is_ground, (_, truth) in zip(found, samples, strict=True)
        ]
    others = (totals.sum(axis=1, keepdims=True) - totals) / (len(samples) - 1)
    held_out = totals[others.argmin(axis=0), np.arange(len(samples))]
    means = totals.mean(axis=1)
    print(
        f"{count} sets: best mean {means.min():.2f}, median {np.median(means):.2f}; "
        f"each file with the set best on the others: {held_out.mean():.2f}"
    )


def _read_samples(folder: Path) -> list[tuple[Float64Array, BoolArray]]:
    surveys = [ts.read(path) for path in _list_files(folder)]
    return [
        (survey.points - survey.points.min(axis=0), survey.attributes["classification"] == GROUND)
        for survey in surveys
    ]


def _list_files(folder: Path) -> list[Path]:
    return sorted(path for path in folder.iterdir() if path.suffix.lower() in (".las", ".laz"))


def _list_cells(errors: list[Errors]) -> list[float | tuple[float, float]]:
    own, *others = errors
    return [*map(float, own), *((float(one.total), float(one.kappa)) for one in others)]


def make_terrain(count: int, seed: int = 1) -> tuple[Float64Array, BoolArray]:
    """Return points on hills with houses, trees and low noise, and which of them are ground."""
    rng = np.random.default_rng(seed)
    side = np.sqrt(count)  # one point a square metre
    x, y = rng.uniform(0, side, (2, count))
    z = 200 + 25 * np.sin(x / 110) * np.cos(y / 140) + 0.05 * x + rng.normal(0, 0.03, count)
    is_ground = np.ones(count, bool)
    block = 60.0  # a house in each square of that side
    is_house = (np.abs(x % block - 30) < 8) & (np.abs(y % block - 30) < 6)
    is_tree = (rng.uniform(size=count) < 0.35) & (np.sin(x / 37) * np.sin(y / 53) > 0.2) & ~is_house
    z[is_house] += 7.0
    z[is_tree] += rng.uniform(1, 18, int(is_tree.sum()))
    is_low = rng.uniform(size=count) < 2e-5
    z[is_low] -= rng.uniform(3, 30, int(is_low.sum()))
    is_ground &= ~(is_house | is_tree | is_low)
    return np.column_stack([x, y, z]).round(2), is_ground


def print_time(count: int) -> None:
    """Print processor seconds and errors on a terrain that is made."""
    points, truth = make_terrain(count)
    begin = time.process_time()
    found = ts.ground(points)
    seconds = time.process_time() - begin
    errors = measure_errors(found.is_ground, truth)
    assert errors.total < 5
    told = ", ".join(f"{name} {value:.2f}" for name, value in errors._asdict().items())
    print(f"{count:,} points: {seconds:.2f} s of processor time; {told}")


def compare_reaches(count: int, side: float = 250.0) -> Table:
    """Show how many labels differ in square tiles, by how far points around them are looked at."""
    points, _ = make_terrain(count)
    whole = ts.ground(points)
    parameters = Parameters(**whole.parameters)
    units = Units(points.min(axis=0), 1.0, 1.0)
    width, height, _ = np.ptp(points, axis=0).tolist()
    frame = Frame.of_all((width, height), parameters.cell, count)
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    boxes = [
        ts.Bounds(x, y, x + side, y + side)
        for x in np.arange(low[0], high[0], side).tolist()
        for y in np.arange(low[1], high[1], side).tolist()
    ]
    table = Table({"reach, m": "{:g}", "labels that differ": "{:,}", "per million": "{:.1f}"})
    for reach in (0.0, 10.0, 20.0, 40.0, 80.0, choose_reach(parameters)):
        different = 0
        for box in boxes:
            window = GroundWindow.around(box, frame, units, parameters, reach)
            rows = np.flatnonzero(are_in_box(points, window.bounds))
            classes = window.classify(points[rows])
            own = are_owned(points[rows], box)
            different += int((classes[own] != whole.classification[rows[own]]).sum())
        table.show(reach, different, different / count * 1e6)
    return table


def main(arguments: list[str] | None = None) -> None:
    """Measure what the command line asks for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.ground", description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, help="LAS and LAZ files with labels")
    parser.add_argument("--points", type=int, metavar="N", help="time a terrain of N points")
    parser.add_argument("--changed", action="store_true", help="turn, thin and cut the files")
    parser.add_argument("--leave-one-out", type=int, metavar="N", help="draw N sets of parameters")
    parser.add_argument("--reach", type=int, metavar="N", help="tiles of a terrain of N points")
    add_option(parser)
    given = parser.parse_args(arguments)
    if (given.changed or given.leave_one_out) and given.folder is None:
        parser.error("a folder of files with labels is needed")
    if given.changed:
        change_points(given.folder).write(given.json)
    if given.leave_one_out:
        print_leave_one_out(given.folder, given.leave_one_out)
    if given.folder is not None and not (given.changed or given.leave_one_out):
        compare_filters(given.folder).write(given.json)
    if given.reach is not None:
        compare_reaches(given.reach).write(given.json)
    if given.points is not None:
        print_time(given.points)


if __name__ == "__main__":
    main()
