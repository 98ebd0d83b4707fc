"""Every product in every format that holds it, by every command: written, read back, compared.

Products are those of :mod:`support.product_calls`, which has to list every function of a surface;
commands are those of the command line. A new one that is missing here fails.
"""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest
from support.commands import run
from support.product_calls import HILL, LINE, PLACE, RESULTS, RING, add_height
from support.terrain_tiles import read_archive

import tinsmith as ts
from tinsmith.cli.command_list import SUMMARIES
from tinsmith.cli.job import Job
from tinsmith.cli.outputs import DOCUMENTS
from tinsmith.io.registry.lookup import known_formats
from tinsmith.io.vector.geometries import read_geometries

# A new command, product or format must not be forgotten, whatever the walk over all of them takes.
pytestmark = [pytest.mark.every_case, pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")]

KINDS = {"Features": ts.Features, "Table": ts.Table, "Raster": ts.Raster, "TIN": ts.TIN}
TABLES = (".csv", ".tsv", ".txt", ".json")
OF_OTHERS = {*TABLES, ".geojson", ".geojsonl", ".gpkg", ".fgb", ".shp", ".parquet", ".dxf", ".xml"}
"""Suffixes that hold features or tables where a command makes these beside a TIN."""

OF_OTHER_KINDS = {
    "Plan": "a drawing",
    "ProfileSheets": "a drawing",
    "SectionSheets": "a drawing",
    "VolumeReport": "a document",
    "Preview": "a page",
    "Coregistration": "has a surface and a table",
    "Difference": "has parts of all kinds",
    "BalancedPad": "has a surface and a table",
}
"""Results that are written by themselves, not by :func:`tinsmith.write`."""


def list_suffixes(kind):
    """Return the first suffix of every format that a kind is written as."""
    written = [one for one in known_formats() if one.write and kind in one.writes]
    suffixes = [one.suffixes[0] for one in written if one.suffixes and one.is_built_in]
    if kind == "Features":
        return [one for one in dict.fromkeys(suffixes) if one not in TABLES]
    return list(TABLES) if kind == "Table" else list(dict.fromkeys(suffixes))


def count(path, kind):
    """Return how much of a product a file has: features, rows, cells or vertices."""
    if kind == "Table":
        if path.suffix == ".json":
            return len(json.loads(path.read_text())["rows"])
        with path.open(newline="") as stream:
            rows = csv.DictReader(stream, delimiter="\t" if path.suffix == ".tsv" else ",")
            return len(list(rows))
    if kind == "Raster":
        import rasterio

        with rasterio.open(path) as found:
            return found.shape
    if path.suffix == ".ifc":  # which is written alone
        import ifcopenshell

        (surface,) = ifcopenshell.open(str(path)).by_type("IfcTriangulatedIrregularNetwork")
        return len(surface.Coordinates.CoordList)
    if kind == "TIN":
        return len(ts.read(path, **({"crs": HILL.crs} if ".geojson" in path.name else {})).points)
    return len(read_geometries(path, crs=HILL.crs))


def require_tiles(made, path):
    """Require that an archive holds tiles of elevations, and that nothing else makes one."""
    if len(made.bands) > 1:
        with pytest.raises(ts.OptionError, match="a tile holds one"):
            ts.write(made, path)
    elif getattr(next(iter(made.units.values()), None), "metres", None) is None:
        with pytest.raises(ts.FormatError, match="is no length"):
            ts.write(made, path)
    else:
        assert read_archive(ts.write(made, path))[1]


def require_drawn(path, made):
    """Require that a drawing holds features: its lines and rings, or points."""
    if made.kind == "points":
        assert len(ts.read(path).points) == len(made)
    elif len(made):
        lines = ts.io.read_lines(path, drape=True)
        assert len(lines) >= len(made)


# ----------------------------------------------------------------------- from Python


@pytest.mark.parametrize("name", RESULTS)
def test_every_product_is_written_to_every_format_and_read_back(tmp_path, name):
    made = RESULTS[name](HILL)
    if type(made).__name__ in OF_OTHER_KINDS:
        return
    kind = next(word for word, one in KINDS.items() if isinstance(made, one))
    for suffix in list_suffixes(kind):
        path = tmp_path / f"a{suffix}"
        if suffix == ".xml" and kind == "Features" and made.kind == "polygons":
            with pytest.raises(ts.FormatError, match="holds points and lines, not polygons"):
                ts.write(made, path)
            continue
        if kind == "Raster" and len(made.bands) > 1 and suffix == ".asc":
            with pytest.raises(ts.OptionError, match="a text grid holds one"):
                ts.write(made, path)
            continue
        if suffix == ".pmtiles":
            require_tiles(made, path)
            continue
        ts.write(made, path)
        if suffix in (".dxf", ".xml") and kind == "Features":
            require_drawn(path, made)
        elif kind == "TIN":
            if suffix != ".glb":  # which is written alone
                assert count(path, kind) == len(made.points), path
        elif kind == "Features" and len(made) == 0:
            assert path.exists()  # layers without features are not read
        else:
            assert count(path, kind) == (made.grid.shape if kind == "Raster" else len(made)), path


# ---------------------------------------------------------------------- from commands

COMMANDS = {
    "contours": ("contours SITE --interval 1", "Features picture"),
    "contours --bands": ("contours SITE --interval 1 --bands", "Features picture"),
    "contours --labels": ("contours SITE --interval 1 --labels", "Features picture"),
    "slope": ("slope SITE", "Features Table"),
    "slope --aspect": ("slope SITE --aspect", "Features Table"),
    "hillshade": ("hillshade SITE --spacing 5", "Raster"),
    "profile": ("profile SITE --line LINE", "Table picture sheets"),
    "profile --sections": ("profile SITE --line LINE --sections 20 20", "Features Table picture"),
    "sections": (
        "sections SITE OTHER --line LINE --interval 20 --width 10",
        "Table picture sheets",
    ),
    "stakeout": ("stakeout SITE --line LINE --interval 20", "Table Features"),
    "volume": ("volume SITE --base 318", "Table Features picture report"),
    "volume of two": ("volume SITE OTHER", "Table Features picture report"),
    "volume --stage-storage": ("volume SITE --stage-storage --interval 50", "Table"),
    "diff": ("diff SITE OTHER", "TIN Table Features picture"),
    "diff --zero-line": ("diff SITE OTHER --zero-line", "TIN Table Features picture"),
    "drape": ("drape SITE LINE", "Features"),
    "raster": ("raster SITE --spacing 5", "Raster"),
    "flow": ("flow SITE --find pits", "Features Table"),
    "flow --find ponds": ("flow SITE --find ponds --level 300", "Features Table"),
    "flow --find catchments": ("flow SITE --find catchments", "Features Table"),
    "flow --find depressions": ("flow SITE --find depressions", "Features Table"),
    "flow --find ridges": ("flow SITE --find ridges", "Features Table"),
    "sight": ("sight SITE --from PLACE --eye-height 2", "Features Table"),
    "sight --to": ("sight SITE --from PLACE --to END --eye-height 2", "Features Table"),
    "inspect": ("inspect SITE", "Features Table picture"),
    "simplify": ("simplify SITE --tolerance 0.1", "TIN"),
    "refine": ("refine SITE --min-angle 20", "TIN"),
    "paste": ("paste SITE PATCH", "TIN"),
    "merge": ("merge PATCH SITE --blend 2", "TIN"),
    "clip": ("clip SITE --by RING", "TIN"),
    "coregister": ("coregister SITE SITE", "TIN Table"),
    "convert": ("convert SITE", "TIN"),
}
OTHERS = {
    "alignment": "writes an axis, and no product of a surface",
    "build": "writes a surface, as convert does",
    "info": "writes nothing",
    "check": "writes a report",
    "view": "writes pages and pictures",
    "compare": "writes pictures",
    "grade": "writes a surface, as paste does",
    "corridor": "writes a surface, as paste does",
    "riverbed": "writes a surface of sections",
    "hydroflatten": "writes a surface, as paste does",
    "ground": "writes points",
    "edit": "writes a surface, as convert does",
    "formats": "writes nothing",
    "interpolate": "writes the points given, with a column more",
    "plan": "writes sheets",
    "completion": "writes a script",
}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    other = HILL.points.copy()
    other[:, 2] += np.sin(other[:, 0] / 9)
    patch = ts.triangulate(add_height(RING, 330), crs=HILL.crs, elevation_unit="m")
    line = ts.Features.of_lines(LINE, [0, 2], columns={"name": ["a"]}, crs=HILL.crs)
    ring = ts.Features.of_polygons([*RING, RING[0]], [0, 5], [0, 1], crs=HILL.crs)
    made = {
        "SITE": ts.write(HILL, folder / "site.gpkg"),
        "OTHER": ts.write(
            ts.triangulate(other, crs=HILL.crs, elevation_unit="m"), folder / "other.gpkg"
        ),
        "PATCH": ts.write(patch, folder / "patch.gpkg"),
        "LINE": ts.write(line, folder / "line.gpkg"),
        "RING": ts.write(ring, folder / "ring.gpkg"),
    }
    places = {"PLACE": PLACE, "END": LINE[1]}
    return {name: [str(path)] for name, path in made.items()} | {
        name: [str(value) for value in place] for name, place in places.items()
    }


def test_every_command_is_here_or_says_what_it_writes():
    assert {line.split()[0] for line, _ in COMMANDS.values()} | {*OTHERS} == {*SUMMARIES}


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_writes_every_format_of_what_it_makes(files, tmp_path, monkeypatch, name):
    line, expected = COMMANDS[name]
    planned = []
    plan = Job.plan
    monkeypatch.setattr(
        Job,
        "plan",
        lambda self, inputs, *kinds, **how: (
            planned.extend(kinds if "choose" not in how else ())
            or plan(self, inputs, *kinds, **how)
        ),
    )
    arguments = [word for part in line.split() for word in files.get(part, [part])]
    kinds = [one for one in expected.split() if one not in ("picture", *DOCUMENTS)]
    tabulated = ["Table"] if kinds == ["Features"] else []
    outputs = {
        tmp_path / f"{kind}{suffix}": kind
        for kind in (*kinds, *tabulated)
        for suffix in list_suffixes(kind)
        if not (kind == "TIN" and len(kinds) > 1 and suffix in OF_OTHERS)
        if not (name == "hillshade" and suffix == ".pmtiles")  # whose cells are no elevations
    }
    given = [word for path in outputs if path.suffix != ".xml" for word in ("-o", str(path))]
    done = run(*arguments, *given, "-q")
    assert done.exit_code == 0, done.output
    assert not planned or sorted(planned) == sorted(expected.split())
    found = {}
    for path, kind in outputs.items():
        if path.suffix in (
            ".xml",
            ".dxf",
            ".glb",
            ".pmtiles",
        ):  # drawings and tiles have no features to count
            continue
        found.setdefault(kind, set()).add(count(path, kind))
    assert {kind: len(counts) for kind, counts in found.items()} == dict.fromkeys(found, 1), found
    if "Features" in kinds and tabulated:
        assert found["Features"] == found["Table"]
    for path in outputs:
        if path.suffix == ".xml":
            done = run(*arguments, "-o", path, "-q")
            assert path.exists() == (done.exit_code == 0)
            assert done.exit_code == 0 or "holds points and lines, not polygons" in done.output
