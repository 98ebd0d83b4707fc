"""Campaign: commands among data sets of one name: only the output that is named changes.

What belongs to a data set is a table of this module, after the manuals of GDAL and Esri.
"""

from __future__ import annotations

import tempfile
import warnings
from functools import cache
from pathlib import Path

import numpy as np
from click.testing import CliRunner

import tinsmith as ts

from .campaign import Campaign, Case
from .samples import MEMORY

BESIDE = {
    ".shp": (".shx", ".dbf", ".prj", ".cpg", ".qpj", ".qix", ".sbn", ".sbx", ".shp.xml"),
    ".tif": (".tfw", ".tif.aux.xml", ".tif.ovr"),
    ".asc": (".prj", ".asc.aux.xml"),
    ".gpkg": (),
    ".csv": (),
    ".ply": (),
    ".obj": (),
    ".fgb": (),
    ".geojson": (),
}
"""Data sets, and the files beside one of a name that belong to it."""

LOOSE = (".prj", ".tfw", ".cpg", ".qpj", ".dbf", ".shx", ".tif.aux.xml", ".aux.xml", ".mtl", ".txt")
"""Files that may lie about without a data set of theirs."""

CRS, OTHER = "EPSG:32616", "EPSG:32617"
POINTS = np.array([[752_700 + 2 * x, 4e6 + 2 * y, 5.0 + x % 3] for x in range(5) for y in range(5)])


def pick(rng: np.random.Generator, items: tuple[str, ...]) -> str:
    return items[int(rng.integers(len(items)))]


def generate(rng: np.random.Generator) -> Case:
    inputs = tuple(BESIDE)
    verb = pick(rng, ("convert", "raster", "contours", "slope", "hillshade"))
    vectors, cells = (".shp", ".gpkg", ".fgb", ".geojson"), (".tif", ".asc")
    outputs = {"convert": (".ply", ".obj", ".shp", ".fgb", ".gpkg"), "raster": cells,
               "hillshade": cells}  # fmt: skip
    return {
        "sets": sorted({pick(rng, inputs) for _ in range(int(rng.integers(1, 4)))}),
        "loose": sorted({pick(rng, LOOSE) for _ in range(int(rng.integers(0, 3)))}),
        "verb": verb,
        "output": pick(rng, outputs.get(verb, vectors)),
        "stem": pick(rng, ("site", "site", "site", "SITE", "other")),
        "moved": bool(rng.random() < 0.6),
        "seed": int(rng.integers(1 << 30)),
    }


@cache
def make_set(suffix: str) -> dict[str, bytes]:
    """Return the files of a data set, by what follows the stem."""
    with tempfile.TemporaryDirectory(dir=MEMORY) as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = Path(folder, f"site{suffix}")
        tin = ts.triangulate(POINTS, crs=CRS, elevation_unit="m")
        if suffix in (".tif", ".asc"):
            ts.write(ts.rasterize(tin, spacing=2.0), path)
        elif suffix in (".ply", ".obj"):
            ts.write(tin, path)
        else:
            ts.write(ts.Features.of_points(POINTS, crs=CRS, elevation_unit="m"), path)
        return {one.name[4:]: one.read_bytes() for one in sorted(Path(folder).iterdir())}


def examine(case: Case) -> str:
    with tempfile.TemporaryDirectory(dir=MEMORY) as name:
        folder = Path(name)
        for suffix in case["sets"]:
            for end, content in make_set(suffix).items():
                (folder / f"site{end}").write_bytes(content)
        for end in case["loose"]:
            if not (folder / f"site{end}").exists():
                (folder / f"site{end}").write_text("kept\n")
        before = {one.name: one.read_bytes() for one in folder.iterdir()}
        exit_code, said = run(case, folder)
        after = {one.name: one.read_bytes() for one in folder.iterdir()}
    assert exit_code in (0, 1, 2), said
    assert "bug" not in said, said
    return require_kept(case, before, after, is_done=exit_code == 0)


def run(case: Case, folder: Path) -> tuple[int, str]:
    from tinsmith.cli import main

    source = folder / f"site{case['sets'][case['seed'] % len(case['sets'])]}"
    target = folder / f"{case['stem']}{case['output']}"
    options = {"raster": ["--spacing", "2"], "hillshade": ["--spacing", "2"],
               "contours": ["--interval", "1"]}.get(case["verb"], [])  # fmt: skip
    crs = ["--crs", CRS] if source.suffix in (".csv", ".geojson") else []
    moved = ["--to-crs", OTHER] if case["moved"] and not crs else []
    arguments = [case["verb"], source, *crs, *options, *moved, "-o", target, "-q"]
    done = CliRunner().invoke(main, [str(one) for one in arguments])
    return done.exit_code, done.output


def require_kept(
    case: Case, before: dict[str, bytes], after: dict[str, bytes], *, is_done: bool
) -> str:
    """Require that nothing changed but the output and what belongs to it alone."""
    changed = {name for name in before | after if before.get(name) != after.get(name)}
    target = f"{case['stem']}{case['output']}"
    if not is_done:
        assert not changed, f"refused, and yet changed: {changed}"
        return "refused"
    own = {target} | {case["stem"] + end for end in BESIDE[case["output"]]}
    of_others = {
        f"site{end}"
        for suffix in case["sets"]
        if f"site{suffix}" != target
        for end in (suffix, *BESIDE[suffix])
    }
    assert target in after
    assert changed <= own, f"changed: {changed - own}"
    harmed = {name for name in changed & of_others if name in before}
    assert not harmed, f"of other data sets: {harmed}"
    return f"written: {case['output']}"


CAMPAIGNS = (
    Campaign(
        "side files",
        "outputs among data sets of the same name: all but the output is left as it was",
        generate,
        examine,
    ),
)
