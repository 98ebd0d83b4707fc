"""How well and how fast the ground is found: labelled samples, beside other filters.

``python -m benchmarks.ground FOLDER`` prints the table of docs/ground.md for the LAS and LAZ files
of a folder whose class 2 is ground, such as the ISPRS filter test (Sithole and Vosselman, "Report:
ISPRS comparison of filters", 2003). ``--points N`` times N points of a terrain that is made, with
houses, trees and low noise.

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

from .measure import is_installed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Filter = Callable[[ts.Survey], NDArray[np.bool_]]

GROUND = 2


class Errors(NamedTuple):
    """Percentages: ground that was missed, others taken, both of all points, Cohen's kappa."""

    type_i: float
    type_ii: float
    total: float
    kappa: float


def measure_errors(found: NDArray[np.bool_], truth: NDArray[np.bool_]) -> Errors:
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


def find_by_tinsmith(survey: ts.Survey) -> NDArray[np.bool_]:
    """Densify a TIN."""
    bare = ts.Survey(points=survey.points, crs=survey.crs)
    return ts.ground(bare).is_ground


def find_by_cloth(survey: ts.Survey) -> NDArray[np.bool_]:
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


def find_by_whitebox(survey: ts.Survey) -> NDArray[np.bool_]:
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


def print_errors(folder: Path) -> None:
    """Print the errors of every filter on every file, as a table of Markdown."""
    files = sorted(path for path in folder.iterdir() if path.suffix.lower() in (".las", ".laz"))
    tools = {name: find for name, (module, find) in FILTERS.items() if is_installed(module)}
    header = ["file", "points", "type I", "type II", "total", "kappa"]
    header += [f"{name}: total, kappa" for name in list(tools)[1:]]
    print(f"| {' | '.join(header)} |\n|{'---|' * len(header)}")
    rows: list[list[float]] = []
    for path in files:
        survey = ts.read(path)
        truth = np.equal(survey.attributes["classification"], GROUND)
        errors = [measure_errors(find(survey), truth) for find in tools.values()]
        rows.append([*errors[0], *(part for one in errors[1:] for part in (one.total, one.kappa))])
        _print_row(path.name, f"{len(survey):,}", rows[-1])
    _print_row("**mean**", "", np.mean(rows, axis=0).tolist())


def _print_row(name: str, count: str, values: list[float]) -> None:
    own = [f"{value:.2f}" for value in values[:4]]
    others = [f"{values[k]:.2f}, {values[k + 1]:.1f}" for k in range(4, len(values), 2)]
    print(f"| {' | '.join([name, count, *own, *others])} |", flush=True)


def make_terrain(count: int, seed: int = 1) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
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


def main(arguments: list[str] | None = None) -> None:
    """Measure what the command line asks for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.ground", description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, help="LAS and LAZ files with labels")
    parser.add_argument("--points", type=int, metavar="N", help="time a terrain of N points")
    given = parser.parse_args(arguments)
    if given.folder is not None:
        print_errors(given.folder)
    if given.points is not None:
        print_time(given.points)


if __name__ == "__main__":
    main()
