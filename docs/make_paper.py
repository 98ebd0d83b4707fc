"""Make the pictures of paper.md, and the figures in its text.

Run ``python docs/make_paper.py [FOLDER]``; needs the extras "plot" and "raster", and some minutes.
"""

from __future__ import annotations

import sys
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

import tinsmith as ts
from tinsmith.tin import paper

if TYPE_CHECKING:
    from tinsmith.base.arrays import Float64Array, Int32Array
    from tinsmith.tin import Comparison, Outcome

HERE = Path(__file__).parent
SAMPLES = HERE.parent / "sample_data"
COLOURS = 64

INK, EDGE, CHOSEN, WANTED = "#333333", "#5b6670", "#c8371b", "#0b5fa5"

CLOSEST = [(0, 0), (0, 1), (0, 2), (1, 3), (3, 3)]
"""Five points of which the closest in the circle makes triangles that are not Delaunay."""

TIED = [(3, 0), (0, 2), (3, 3), (1, 2), (2, 2), (2, 1)]
"""Six points, in this order, on which the angle rule crosses itself."""

TIED_BY_DISTANCE = [(0, 2), (0, 3), (2, 1), (1, 1), (3, 3), (0, 1), (2, 0), (0, 0)]
"""Eight points, in this order, on which it crosses itself though distance breaks its ties."""

SEED = 1
WINDOW = ts.Bounds(745_000.0, 4_010_000.0, 748_405.0, 4_013_405.0)
SETS = 40


def main(folder: Path = HERE) -> None:
    """Make the pictures and print the figures."""
    draw_counterexamples(folder / "paper-counterexamples.png")
    found = {name: ts.compare(points) for name, points in data().items()}
    for name, comparison in found.items():
        tell(name, comparison)
    draw(found["75 random"], folder / "paper-75.png", "75 random points")
    draw(found["site survey"], folder / "paper-site.png", "Site survey, 2,121 points")
    bad = ts.compare(random_points(75, 2))
    tell("75 random, seed 2", bad)
    draw(bad, folder / "paper-75-overlap.png", "Another 75 random points")
    tell_removal()
    tell_odds(75)
    tell_ties(100)
    tell_breeding(2_000)


def random_points(n: int, seed: int) -> Float64Array:
    """Return points in a square of 100 by 100."""
    return 100 * np.random.default_rng(seed).random((n, 3))


def data() -> dict[str, Float64Array]:
    """Return the point sets compared."""
    sets = {f"{n:,} random": random_points(n, SEED) for n in (75, 500, 2_000)}
    sets["site survey"] = ts.read(SAMPLES / "site_survey.csv").points
    sets["raster"] = ts.read(SAMPLES / "jacksboro.tif", window=WINDOW).points
    return sets


# ---------------------------------------------------------------- figures


def tell(name: str, comparison: Comparison) -> None:
    """Print rows of a table, one for each algorithm."""
    for outcome in comparison.outcomes:
        print(f"| {name} | {' | '.join(cells(outcome, comparison))} |")


def cells(outcome: Outcome, comparison: Comparison) -> list[str]:
    """Return one algorithm's figures."""
    count = len(outcome.triangles)
    without = outcome.candidates_without_removal
    stopped = " (stopped)" if outcome.is_stopped else ""
    return [
        outcome.name,
        f"{count:,}{stopped} of {comparison.expected:,}",
        f"{len(outcome.unextended):,}",
        f"{100 * outcome.violating.mean():.1f} %",
        f"{100 * outcome.overlap / comparison.area:.1f} %",
        f"{100 * outcome.gap / comparison.area:.1f} %",
        f"{outcome.angles.min():.2f}°, {100 * outcome.angle_counts[:2].sum() / count:.1f} %",
        f"{outcome.candidates / count:,.0f}"
        + ("" if without is None else f" ({without / count:,.0f})"),
        f"{outcome.tests:,}",
        f"{1000 * outcome.seconds:,.1f} ms",
        f"{outcome.memory / 1000:,.0f} kB",
    ]


def tell_removal() -> None:
    """Print what removal saves, in two runs of the original."""
    for n in (75, 500, 2_000):
        points = random_points(n, SEED)
        with_it, without = (paper.original(points, removal=one) for one in (True, False))
        same = np.array_equal(with_it.triangles, without.triangles)
        saved = 100 * (1 - with_it.candidates / without.candidates)
        print(
            f"removal, {n} points: {with_it.candidates:,} candidates instead of "
            f"{without.candidates:,}, {saved:.0f} % fewer; same triangles: {same}"
        )


def tell_odds(n: int) -> None:
    """Print how the improved algorithm fares on many sets of random points."""
    whole = violating = due = 0
    for seed in range(SETS):
        comparison = ts.compare(random_points(n, seed))
        improved = comparison.outcomes[1]
        if improved.overlap == improved.gap == 0:
            whole += 1
            violating += int(improved.violating.sum())
            due += comparison.expected
    share = 100 * violating / due
    print(
        f"{SETS} sets of {n} points: {whole} triangulated whole, of which {share:.1f} % violating"
    )


def tell_ties(n: int) -> None:
    """Print how the reading in which distance breaks ties fares beside the original."""
    for name, make in (("random points", random_points), ("points of a lattice", lattice_points)):
        found = [ts.compare(make(n, seed)).outcomes for seed in range(SETS)]
        for k in (0, 3):
            exact = sum(same_triangles(one[k], one[4]) for one in found)
            due = sum(len(one[k].triangles) == len(one[4].triangles) for one in found)
            print(
                f"{SETS} sets of {n} {name}, {found[0][k].name}: {exact} times the exact "
                f"triangulation, {due} times as many triangles"
            )


def lattice_points(n: int, seed: int) -> Float64Array:
    """Return places of whole numbers, of which many lie on one circle."""
    places = np.random.default_rng(seed).permutation(15 * 15)[:n]
    return np.column_stack([places // 15, places % 15, np.zeros(n)])


def same_triangles(one: Outcome, other: Outcome) -> bool:
    """Tell whether two outcomes have the same triangles, in any order."""
    first, second = (
        {tuple(sorted(corners)) for corners in each.triangles.tolist()} for each in (one, other)
    )
    return first == second and len(one.triangles) == len(other.triangles)


def tell_breeding(n: int) -> None:
    """Print to how many triangles the improved algorithm grows if nothing stops it."""
    for seed in (1, 2, 3):
        network = paper.improved(random_points(n, seed))
        print(f"{n} points, seed {seed}: {len(network.triangles):,} triangles in the end")


# ---------------------------------------------------------------- pictures


def draw(comparison: Comparison, path: Path, title: str) -> None:
    """Draw all algorithms side by side: the paper's Figure 5."""
    save(ts.comparison_picture(comparison, title=title), path, dpi=90)


def save(figure: Figure, path: Path, *, dpi: int) -> None:
    """Write a picture in few colours, which keeps the file small."""
    picture = BytesIO()
    figure.savefig(picture, format="png", dpi=dpi)
    Image.open(picture).convert("RGB").quantize(
        COLOURS, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE
    ).save(path, optimize=True)


def draw_counterexamples(path: Path) -> None:
    """Draw the smallest sets of points found on which the rules fail, and what is right."""
    figure = Figure(figsize=(12.0, 11.4), layout="constrained")
    upper, middle, lower = figure.subplots(3, 2)
    draw_closest(upper)
    draw_tied(middle, TIED, "original", "Largest angle, the first of equals")
    draw_tied(lower, TIED_BY_DISTANCE, "improved (ties)", "Largest angle, of equals the closest")
    for axes in (*upper, *middle, *lower):
        axes.set_aspect("equal")
        axes.set_axis_off()
    save(figure, path, dpi=100)


def draw_closest(panels: Any) -> None:
    """Draw the choice at an edge: closest in its circle, and widest angle."""
    points = flat(CLOSEST)
    # The edge from (0, 1) to (3, 3), with the circle on it, and the circle of the right triangle.
    draw_network(panels[0], points, paper.improved(points).triangles, [(1, 4, 2), (2, 4, 3)])
    draw_network(panels[1], points, paper.original(points).triangles, [])
    draw_circle(panels[0], *circle_on(points[1], points[4]), CHOSEN)
    draw_circle(panels[0], *circle_through(points[[1, 4, 2]]), CHOSEN, style=":")
    draw_circle(panels[1], *circle_through(points[[1, 4, 3]]), WANTED)
    panels[0].set_title(
        "Closest in the circle on the edge (solid):\na point lies in the triangle's circle (dotted)"
    )
    panels[1].set_title("Widest angle: the circle is empty")


def draw_tied(panels: Any, places: list[tuple[int, int]], name: str, rule: str) -> None:
    """Draw how triangles cross each other if ties are broken for each edge alone."""
    points = flat(places)
    found = {one.name: one for one in ts.compare(points).outcomes}
    tied, exact = found[name], found["exact"].triangles
    draw_network(panels[0], points, tied.triangles, tied.triangles[tied.overlapping].tolist())
    draw_network(panels[1], points, exact, [])
    panels[0].set_title(f"{rule}: {len(tied.triangles)} triangles, crossing")
    panels[1].set_title(f"Ties broken by coordinates: {len(exact)} triangles")
    for axes in panels:
        for row, (x, y) in enumerate(places):
            axes.annotate(str(row + 1), (x, y), (6, 6), textcoords="offset points", color=INK)


def draw_network(axes: Any, points: Float64Array, triangles: Int32Array, faults: list[Any]) -> None:
    """Draw triangles, some of them marked."""
    for corners in faults:
        axes.fill(*points[list(corners), :2].T, color=CHOSEN, alpha=0.22, linewidth=0)
    for corners in triangles:
        axes.fill(*points[corners, :2].T, fill=False, edgecolor=EDGE, linewidth=1.4)
    axes.plot(*points[:, :2].T, "o", color=INK, markersize=6)


def draw_circle(axes: Any, center: Any, radius: float, color: str, *, style: str = "-") -> None:
    """Draw a circle."""
    turn = np.linspace(0, 2 * np.pi, 200)
    x, y = center[0] + radius * np.cos(turn), center[1] + radius * np.sin(turn)
    axes.plot(x, y, style, color=color, linewidth=1.4)


def circle_on(p: Float64Array, q: Float64Array) -> tuple[Any, float]:
    """Return centre and radius of the circle whose diameter is an edge."""
    return (p[:2] + q[:2]) / 2, float(np.hypot(*(q - p)[:2])) / 2


def circle_through(corners: Float64Array) -> tuple[Any, float]:
    """Return centre and radius of a triangle's circle."""
    a, *others = corners[:, :2]
    rows = np.array(others) - a
    offset = np.linalg.solve(2 * rows, (rows**2).sum(axis=1))
    return a + offset, float(np.hypot(*offset))


def flat(places: list[tuple[int, int]]) -> Float64Array:
    """Return places as points of height 0."""
    return np.array([(x, y, 0.0) for x, y in places])


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
