"""All outputs of one run say the same: tables, layers, pictures' words, files, JSON, summary."""

import csv
import json
import re
from itertools import combinations

import numpy as np
import pytest
from support.commands import run_command

import tinsmith as ts
from tinsmith.cli.command_list import SUMMARIES
from tinsmith.io.vector.geometries import read_geometries

# A new command, product or format must not be forgotten, whatever the walk over all of them takes.
pytestmark = pytest.mark.every_case

CRS = "EPSG:32616"
UTM = ("--crs", CRS, "--elevation-unit", "m")
RING = [[700_030, 4_000_030], [700_060, 4_000_030], [700_060, 4_000_060], [700_030, 4_000_060]]
SLOPES = ("--cut-slope", 2, "--fill-slope", 2)
NO_SURFACE = {"completion", "formats", "alignment", "riverbed"}
"""Commands that read nothing, an axis or sections."""
_NUMBER = re.compile(r"(?<![\w.])-?\d[\d,]*(?:\.\d+)?")


class Run:
    """A command that was run once with all kinds of outputs."""

    def __init__(self, command, *arguments, figures, file="hill.csv", crs=UTM):
        done = run_command(command, file, *arguments, *crs, "--json")
        self.record = json.loads(done.stdout)
        self.words = " ".join(words for figure in figures for words in list_words(figure))
        self.summary = {}
        label = ""
        for line in done.stderr.splitlines():
            label = line[:12].strip() or label
            self.summary[label] = f"{self.summary.get(label, '')} {line[12:]}"

    def numbers(self, label):
        """Return the numbers in a row of the summary."""
        return read_numbers(self.summary[label])

    def words_after(self, *starts):
        """Return the number behind each word in the pictures."""
        return [read_numbers(self.words.split(one, 1)[1])[0] for one in starts]


def list_words(figure):
    from matplotlib.text import Text

    return [one.get_text() for one in figure.findobj(Text) if one.get_visible()]


def read_numbers(text):
    """Return numbers with half a unit of their last digit."""
    found = [one.rstrip(",") for one in _NUMBER.findall(text)]
    return [
        (float(one.replace(",", "")), 0.5000001 * 10.0 ** -len(one.partition(".")[2]))
        for one in found
    ]


def as_pairs(values):
    """Return values, exact but for rounding, as pairs with their tolerance."""
    return [one if isinstance(one, tuple) else (one, 1e-7 * abs(one) + 1e-6) for one in values]


def require_agreement(said):
    """Compare quantities, name -> numbers, of every pair of outputs."""
    apart = []
    for (one, mine), (other, theirs) in combinations(said.items(), 2):
        shared = mine.keys() & theirs.keys()
        assert shared, f"{one} and {other} have nothing that can be compared"
        for name in sorted(shared):
            left, right = as_pairs(mine[name]), as_pairs(theirs[name])
            same = len(left) == len(right) and all(
                abs(a - b) <= s + t for (a, s), (b, t) in zip(left, right, strict=True)
            )
            apart += [] if same else [(name, one, left, other, right)]
    assert apart == []


def read_table(path):
    with path.open(encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    return [{name.split(" (")[0]: value for name, value in row.items()} for row in rows]


def sum_of(rows, name):
    return float(sum(float(row[name]) for row in rows))


def read_layer(path):
    return read_geometries(path, crs=CRS)


# ---------------------------------------------------------------- what each command says


def compare_meshes(command, out, label, *arguments, of=("vertices", "triangles")):
    """Compare the counts of a TIN in summary, record and file."""

    def gather(folder, figures):
        run = Run(command, *arguments, "-o", out, figures=figures)
        tin = ts.read(folder / out)
        sizes = {"vertices": [len(tin.points)], "triangles": [len(tin.triangles)]}
        told = dict(zip(of, ([one] for one in run.numbers(label)), strict=False))
        return {
            "file": sizes,
            "record": {name: [run.record["tin"][name]] for name in of},
            "summary": told,
        }

    return gather


def compare_volumes(*arguments):
    def gather(folder, figures):
        outputs = [word for name in ("v.csv", "v.gpkg", "v.png") for word in ("-o", name)]
        run = Run("volume", *arguments, *outputs, figures=figures)
        rows, layer = read_table(folder / "v.csv"), read_layer(folder / "v.gpkg").columns
        run_command("volume", "hill.csv", *arguments, *UTM, "-o", "alone.csv")
        tables = {"table": rows, "table alone": read_table(folder / "alone.csv")}
        said = {name: {} for name in (*tables, "layer", "record", "picture", "summary")}
        caption = re.search(r"Cut .*? over .*?; fill .*? over [^;]*", run.words)[0]
        drawn = read_numbers(caption.replace("m³", "").replace("m²", ""))
        told = run.summary["Cut"], run.summary["Fill"]
        for k, kind in enumerate(("cut", "fill")):
            chosen = layer["kind"].astype(str) == kind
            for name, found in tables.items():
                said[name] |= {
                    kind: [sum_of(found, kind)],
                    f"{kind} area": [sum_of(found, f"{kind}_area")],
                }
            said["layer"] |= {
                kind: [layer["volume"][chosen].sum()],
                f"{kind} area": [layer["area"][chosen].sum()],
            }
            said["record"] |= {
                kind: [sum_of(run.record["rows"], kind)],
                f"{kind} area": [sum_of(run.record["rows"], f"{kind}_area")],
            }
            said["picture"] |= {kind: [drawn[2 * k]], f"{kind} area": [drawn[2 * k + 1]]}
            pairs = read_numbers(told[k].replace("m³", "").replace("m²", ""))
            said["summary"] |= {
                kind: [add(pairs[::2])],
                f"{kind} area": [add(pairs[1::2])],
            }
        return said

    return gather


def add(pairs):
    """Return the sum of rounded numbers."""
    return tuple(map(float, np.sum(pairs, axis=0)))


def compare_shift(folder, figures):
    """Compare statistics and counts of a surface that was moved by half a cell."""
    points = ts.read(folder / "hill.csv", crs=CRS).points
    points = points + np.column_stack([0 * points[:, :2], 3 * np.sin(points[:, 1] / 9)])
    for name, move in (("wavy", 0.0), ("moved", np.array([2.5, 1.0, 0.5]))):
        rows = [f"{x},{y},{z}" for x, y, z in (points + move).tolist()]
        (folder / f"{name}.csv").write_text("\n".join(["easting,northing,elevation", *rows]))
    outputs = ("-o", "k.csv", "-o", "k.ply")
    run = Run("coregister", "wavy.csv", *outputs, file="moved.csv", figures=figures)
    tin = ts.read(folder / "k.ply")
    sizes = {"vertices": [len(tin.points)], "triangles": [len(tin.triangles)]}
    table = read_table(folder / "k.csv")
    said = {name: [float(row[name]) for row in table] for name in ("nmad", "median", "rms")}
    cells = {"cells": [float(table[1]["cells"])]}
    told = {name: run.numbers({"nmad": "NMAD", "rms": "RMS"}.get(name, "Median")) for name in said}
    rows = run.record["statistics"]
    counts = dict(zip(sizes, ([one] for one in run.numbers("Shifted")), strict=False))
    return {
        "file": sizes,
        "table": said | cells | sizes,
        "record": {name: [row[name] for row in rows] for name in said}
        | {name: [run.record["tin"][name]] for name in sizes}
        | {"cells": [rows[1]["cells"]], "shift": run.record["shift"]},
        "summary": told | counts | {"cells": run.numbers("Cells"), "shift": run.numbers("Shift")},
    }


def compare_difference(folder, figures):
    outputs = [word for name in ("d.ply", "d.csv", "d.gpkg", "d.png") for word in ("-o", name)]
    run = Run("diff", "flat.csv", *outputs, figures=figures)
    (row,), layer = read_table(folder / "d.csv"), read_layer(folder / "d.gpkg").columns
    tin = ts.read(folder / "d.ply", crs=CRS, elevation_unit="m")
    table = ts.volume(tin, base=0.0)
    kinds = layer["kind"].astype(str)
    volumes = {kind: [layer["volume"][kinds == kind].sum()] for kind in ("cut", "fill")}
    statistics = {name: [float(row[name])] for name in ("mean", "lowest", "highest", "area")}
    cut, _, fill, *_ = read_numbers(
        run.words.split("Cut ", 1)[1].replace("m³", "").replace("m²", "")
    )
    net = volumes["fill"][0] - volumes["cut"][0]
    return {
        "table": statistics | {"net": [float(row["mean"]) * float(row["area"])]},
        "layer": {**volumes, "area": [layer["area"].sum()], "net": [net]},
        "record": {name: [run.record["statistics"][name]] for name in statistics}
        | {"cut": [run.record["cut"]], "fill": [run.record["fill"]]}
        | {"net": [run.record["fill"] - run.record["cut"]]},
        "picture": {"cut": [cut], "fill": [fill], "net": [add([(-cut[0], cut[1]), fill])]},
        "summary": {
            "mean": run.numbers("Mean")[:1],
            "area": run.numbers("Area")[:1],
            "lowest": run.numbers("Range")[:1],
            "net": [(run.numbers("Mean")[0][0] * run.numbers("Area")[0][0], 0.5)],
        },
        "TIN": {"cut": [table["fill"][0]], "fill": [table["cut"][0]]}
        | {"net": [table["cut"][0] - table["fill"][0]], "area": [table["area"][0]]},
    }


def compare_contours(folder, figures):
    run = Run(
        "contours",
        "--interval",
        1,
        "--smooth",
        0.05,
        "-o",
        "c.gpkg",
        "-o",
        "c.png",
        figures=figures,
    )
    layer = read_layer(folder / "c.gpkg")
    levels = np.unique(layer.columns["elevation"])
    lines = figures[-1].axes[0].collections
    drawn = {float(one) for one in re.findall(r"(?<!\d)3\d\d(?!\d)", run.words)}
    assert drawn <= set(levels.tolist())
    return {
        "layer": {
            "lines": [len(layer)],
            "range": [levels[0], levels[-1]],
            "step": [1.0],
            "length": [layer.columns["length"].sum()],
        },
        "record": {
            "lines": [run.record["features"]],
            "range": [run.record["levels"][0], run.record["levels"][-1]],
            "step": [1.0],
            "length": [run.record["length"]],
        },
        "summary": {
            "lines": run.numbers("Contours")[:1],
            "range": run.numbers("Levels")[1:3],
            "step": [1.0],
        },
        "picture": {
            "step": run.words_after("every"),
            "lines": [sum(len(one.get_paths()) for one in lines if hasattr(one, "get_segments"))],
        },
    }


def compare_slopes(folder, figures):
    run = Run("slope", "-o", "s.gpkg", "-o", "s.csv", figures=figures)
    layer, rows = read_layer(folder / "s.gpkg").columns, read_table(folder / "s.csv")
    classes, statistics = run.record["classes"], run.record["slope"]
    areas = [read_numbers(one)[0] for one in re.findall(r": ([\d,.]+) m²", run.summary["Classes"])]
    return {
        "layer": {"areas": layer["area"].tolist(), "area": [layer["area"].sum()]},
        "record": {
            "areas": [one["area"] for one in classes],
            "area": [statistics["area"]],
            "slopes": [statistics[name] for name in ("minimum", "maximum", "mean")],
        },
        "table": {"areas": [float(row["area"]) for row in rows], "area": [sum_of(rows, "area")]},
        "summary": {
            "areas": areas,
            "area": [add(areas)],
            "slopes": run.numbers("Slope")[:3],
        },
    }


def compare_quantities(folder, figures):
    line = ("--line", "cut.geojson", "--interval", 10, "--width", 8)
    run = Run("sections", "flat.csv", *line, "-o", "q.csv", "-o", "q.png", figures=figures)
    rows, record = read_table(folder / "q.csv"), run.record["rows"]
    last = {"table": rows[-1], "record": record[-1]}
    said = {
        name: {
            "cut": [float(row["cut_total"])],
            "fill": [float(row["fill_total"])],
            "mass": [float(row["mass"])],
        }
        for name, row in last.items()
    }
    said["summary"] = {
        kind: [read_numbers(run.summary[kind.capitalize()].replace("m³", ""))[0]]
        for kind in ("cut", "fill")
    }
    left = read_numbers(re.search(r"(?:waste|borrow): (\S+)", run.words)[1])[0]
    sign = 1.0 if "waste" in run.words else -1.0
    said["picture"] = {"mass": [(sign * left[0], left[1])]}
    said["summary"]["mass"] = [read_numbers(run.summary["Mass"].replace("+", ""))[0]]
    return said


def compare_stakes(folder, figures):
    run = Run(
        "stakeout", "--at", "places.csv", "--ground", "flat.csv",
        "-o", "k.csv", "-o", "k.gpkg", figures=figures,
    )  # fmt: skip
    rows, layer = read_table(folder / "k.csv"), read_layer(folder / "k.gpkg")
    told = run.numbers("Points")
    record = run.record["rows"]
    names = ("elevation", "cut", "fill")
    heights = np.nan_to_num(ts.read(folder / "k.gpkg").points[:, 2])
    return {
        "table": {"points": [len(rows)]}
        | {one: [float(row[one] or 0) for row in rows] for one in names},
        "layer": {
            "points": [len(layer)],
            "elevation": heights,
            "cut": np.nan_to_num(layer.columns["cut"]),
            "fill": np.nan_to_num(layer.columns["fill"]),
        },
        "record": {"points": [run.record["points"]]}
        | {one: [row[one] or 0.0 for row in record] for one in names},
        "summary": {"points": told[:1]},
    }


def compare_profiles(folder, figures):
    run = Run(
        "profile", "flat.csv", "--line", "axis.geojson", "--interval", 20,
        "-o", "p.csv", "-o", "p.png", figures=figures,
    )  # fmt: skip
    rows = read_table(folder / "p.csv")
    stations = [float(row["station"]) for row in rows]
    heights = [float(row["elevation_hill"]) for row in rows if row["elevation_hill"]]
    lines = [line for axes in figures[-1].axes for line in axes.get_lines()]
    drawn = max((np.asarray(line.get_xdata(), float) for line in lines), key=len)
    high = max(
        (np.asarray(line.get_ydata(), float) for line in lines),
        key=lambda one: np.isfinite(one).sum(),
    )
    ranges = run.record["ranges"]
    return {
        "table": {
            "rows": [len(rows)],
            "ends": [stations[0], stations[-1]],
            "range": [min(heights), max(heights)],
        },
        "record": {
            "rows": [run.record["rows"]],
            "ends": ranges["station"],
            "range": ranges["elevation_hill"],
        },
        "picture": {
            "rows": [len(drawn)],
            "ends": [drawn[0], drawn[-1]],
            "range": [np.nanmin(high), np.nanmax(high)],
        },
        "summary": {"rows": run.numbers("Rows")[:1]},
    }


def compare_sections(folder, figures):
    run = Run(
        "profile", "flat.csv", "--line", "axis.geojson", "--sections", 20, 30,
        "-o", "x.csv", "-o", "x.png", "-o", "x.gpkg", figures=figures,
    )  # fmt: skip
    rows, layer = read_table(folder / "x.csv"), read_layer(folder / "x.gpkg").columns
    in_table = sorted({float(row["station"]) for row in rows})
    ends = {"ends": [in_table[0], in_table[-1]]}
    drawn = [read_numbers(one)[0] for one in re.findall(r"Station ([\d,.]+)", run.words)]
    return {
        "table": {"stations": in_table, "rows": [len(rows)]} | ends,
        "layer": {"stations": np.unique(layer["station"]).tolist()} | ends,
        "picture": {"stations": drawn, "ends": [drawn[0], drawn[-1]]},
        "record": {"rows": [run.record["rows"]], "ends": run.record["ranges"]["station"]},
    }  # the summary tells rows alone, which have no part in layer and picture


def compare_inspection(folder, figures):
    outputs = [word for name in ("i.csv", "i.gpkg", "i.png") for word in ("-o", name)]
    run = Run("inspect", *outputs, figures=figures, file="wrong.csv")
    rows, layer = read_table(folder / "i.csv"), read_layer(folder / "i.gpkg")
    assert len(rows) > 0
    (drawn,) = re.findall(r"(\d+) findings", run.words)
    return {
        "table": {"found": [len(rows)]},
        "layer": {"found": [len(layer)]},
        "record": {"found": [len(run.record["blunders"])]},
        "picture": {"found": [float(drawn)]},
        "summary": {"found": run.numbers("Findings")[:1]},
    }


def compare_views(folder, figures):
    run = Run(
        "sight", "--from", 700_040, 4_000_041, "--eye-height", 2, "-o", "s.gpkg", "-o", "s.csv",
        figures=figures,
    )  # fmt: skip
    layer, rows = read_layer(folder / "s.gpkg").columns, read_table(folder / "s.csv")
    told = [run.numbers(name)[0] for name in ("Visible", "Hidden")]
    return {
        "table": {"areas": [float(row["area"]) for row in rows]},
        "layer": {"areas": layer["area"].tolist()},
        "record": {"areas": [one["area"] for one in run.record["found"]]},
        "summary": {"areas": told},
    }


def compare_depressions(folder, figures):
    run = Run(
        "flow",
        "--find",
        "depressions",
        "-o",
        "f.gpkg",
        "-o",
        "f.csv",
        figures=figures,
        file="pit.csv",
    )
    layer, rows = read_layer(folder / "f.gpkg"), read_table(folder / "f.csv")
    volumes = [one["volume"] for one in run.record["found"]]
    return {
        "table": {"found": [len(rows)], "volumes": [float(row["volume"]) for row in rows]},
        "layer": {"found": [len(layer)], "volumes": layer.columns["volume"].tolist()},
        "record": {"found": [len(volumes)], "volumes": volumes},
        "summary": {"found": run.numbers("Found")[:1]},
    }


def compare_raster(command):
    def gather(folder, figures):
        run = Run(command, "--spacing", 5, "-o", "r.tif", figures=figures)
        import rasterio

        with rasterio.open(folder / "r.tif") as file:
            size, cell = [file.height, file.width], [file.res[0]]
        told = run.numbers("Raster")
        record = run.record.get("raster", run.record)
        shape = record.get("shape") or [record["rows"], record["columns"]]
        return {
            "file": {"size": size, "cell": cell},
            "record": {"size": shape, "cell": [record["spacing"]]},
            "summary": {"size": told[:2], "cell": told[2:3]},
        }

    return gather


def compare_plan(folder, figures):
    run = Run("plan", "-o", "p.svg", "-o", "p.pdf", "-o", "p.png", figures=figures)
    import subprocess

    pdf = subprocess.run(
        ["pdftotext", "-layout", folder / "p.pdf", "-"], capture_output=True, text=True, check=True
    ).stdout
    svg = " ".join(re.findall(r">([^<>]+)<", (folder / "p.svg").read_text(encoding="utf-8")))

    def read(text):
        return {
            "scale": [read_numbers(re.search(r"1\s?:\s?([\d,]+)", text)[1])[0]],
            "interval": [read_numbers(re.search(r"(?i)contour interval ([\d.]+)", text)[1])[0]],
        }

    return {
        "PDF": read(pdf),
        "SVG": read(svg),
        "record": {"scale": [run.record["scale"]], "interval": [run.record["interval"]]},
        "summary": {
            "scale": run.numbers("Scale")[-1:],
            "interval": run.numbers("Contours")[:1],
        },
    }


def compare_classes(folder, figures):
    run = Run("ground", "--any-return", "-o", "g.csv", figures=figures)
    rows = read_table(folder / "g.csv")
    return {
        "file": {"points": [len(rows)]},
        "record": {
            "points": [run.record["survey"]["points"]],
            "ground": [run.record["classes"]["ground"]],
        },
        "summary": {"points": run.numbers("Points")[:1], "ground": run.numbers("Ground")[:1]},
    }


def compare_draped(folder, figures):
    run = Run("drape", "ring.geojson", "-o", "d.gpkg", figures=figures)
    layer = read_layer(folder / "d.gpkg")
    told = run.numbers("Draped")
    return {
        "layer": {"features": [len(layer)], "vertices": [len(layer.coordinates)]},
        "record": {
            "features": [run.record["draped"]],
            "vertices": [run.record["vertices_draped"]],
        },
        "summary": {"features": told[:1], "vertices": told[-1:]},
    }


def compare_interpolated(folder, figures):
    run = Run("interpolate", "--at", "places.csv", "-o", "i.csv", figures=figures)
    return {
        "table": {"points": [len(read_table(folder / "i.csv"))]},
        "record": {"points": [run.record["points"]]},
        "summary": {"points": run.numbers("Points")[:1]},
    }


def compare_check(folder, figures):
    del folder
    run = Run("check", figures=figures)
    plain = run_command("check", "hill.csv", *UTM)
    told = read_numbers(plain.stdout + plain.stderr)
    counts = run.record["counts"]
    return {
        "record": {"vertices": [counts["vertices"]]},
        "summary": {"vertices": [one for one in told if one[0] == counts["vertices"]][:1]},
    }


def compare_converted(folder, figures):
    run = Run("convert", "-o", "o.xyz", figures=figures)
    assert run.record["outputs"] == ["o.xyz"]
    return {
        "file": {"points": [len(ts.read(folder / "o.xyz", columns="ENZ"))]},
        "summary": {"points": run.numbers("Read")[:1]},
    }


def compare_info(folder, figures):
    del folder
    run_command("build", "hill.csv", *UTM, "-o", "hill.gpkg")
    run = Run("info", "--plot", "i.png", figures=figures, file="hill.gpkg", crs=())
    plain = run_command("info", "hill.gpkg")
    (told,) = re.findall(r"([\d,]+) triangles", plain.stdout + plain.stderr)[:1]
    (drawn,) = re.findall(r"([\d,]+) triangles", run.words)[:1]
    return {
        "record": {"triangles": [run.record["triangles"]]},
        "summary": {"triangles": read_numbers(told)},
        "picture": {"triangles": read_numbers(drawn)},
    }


def compare_algorithms(folder, figures):
    del folder
    run = Run("compare", "--sample", 50, "-o", "c.png", figures=figures)
    plain = run_command("compare", "hill.csv", "--sample", 50, *UTM)
    drawn = [read_numbers(one)[0] for one in re.findall(r"([\d,]+) of [\d,]+ triangles", run.words)]
    found = [float(one["triangles"]) for one in run.record["outcomes"]]
    told = read_numbers(re.search(r"(?m)^Triangles.*$", plain.stdout)[0])
    return {
        "record": {"triangles": found, "expected": [run.record["expected_triangles"]]},
        "picture": {"triangles": drawn},
        "summary": {"triangles": told},
    }


def compare_page(folder, figures):
    run = Run("view", "-o", "v.html", figures=figures)
    assert (folder / "v.html").stat().st_size > 0
    return {
        "record": {"pages": [float(run.record["output"] == "v.html")]},
        "summary": {"pages": [float("v.html" in run.summary["Written"])]},
    }


AGREEMENTS = {
    "build": [compare_meshes("build", "b.ply", "TIN", "--report", "b.json")],
    "check": [compare_check],
    "clip": [compare_meshes("clip", "c.ply", "Clipped", "--by", "ring.geojson")],
    "compare": [compare_algorithms],
    "contours": [compare_contours],
    "convert": [compare_converted],
    "coregister": [
        compare_shift,
    ],
    "corridor": [compare_meshes("corridor", "k.ply", "Corridor", "road.geojson", "template.csv")],
    "diff": [compare_difference],
    "drape": [compare_draped],
    "edit": [compare_meshes("edit", "e.ply", "TIN", "edits.json")],
    "flow": [compare_depressions],
    "grade": [
        compare_meshes(
            "grade", "g.ply", "Graded", "--pad", "ring.geojson", "--elevation", 322, *SLOPES
        )
    ],
    "ground": [compare_classes],
    "hillshade": [compare_raster("hillshade")],
    "hydroflatten": [
        compare_meshes(
            *("hydroflatten", "f.ply", "Flattened", "--stream", "stream.geojson"),
            *("--downstream", "along", "--spacing", 5),
        )
    ],
    "info": [compare_info],
    "inspect": [compare_inspection],
    "interpolate": [compare_interpolated],
    "merge": [compare_meshes("merge", "m.ply", "Merged", "flat.csv", "--blend", 3)],
    "paste": [compare_meshes("paste", "p.ply", "Pasted", "flat.csv")],
    "plan": [compare_plan],
    "profile": [compare_profiles, compare_sections],
    "raster": [compare_raster("raster")],
    "refine": [compare_meshes("refine", "r.ply", "Mesh")],
    "sections": [compare_quantities],
    "sight": [compare_views],
    "simplify": [compare_meshes("simplify", "s.ply", "Left", "--tolerance", 0.1)],
    "slope": [compare_slopes],
    "stakeout": [compare_stakes],
    "view": [compare_page],
    "volume": [
        compare_volumes("--base", 322),
        compare_volumes("--base", 322, "--regions", "ring.geojson"),
        compare_volumes("flat.csv", "--regions", "two.geojson"),
    ],
}
"""Of each command, what gathers the quantities that its outputs tell."""


def write_features(path, *shapes):
    """Write shapes, each a name with a geometry, as GeoJSON in the CRS of the tests."""
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32616"}}
    features = [
        {"type": "Feature", "properties": {"name": name}, "geometry": shape}
        for name, shape in shapes
    ]
    record = {"type": "FeatureCollection", "crs": crs, "features": features}
    path.write_text(json.dumps(record))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, odd in (("hill", {}), ("wrong", {213: 0.0, 90: 900.0}), ("pit", {213: 318.0})):
        rows = ["number,easting,northing,elevation"]
        for i in range(400):
            x, y = divmod(i, 20)
            z = odd.get(i, 320 + 0.05 * x * (20 - x) + 0.1 * y)
            rows.append(f"{1000 + i},{700_000 + 5 * x},{4_000_000 + 5 * y},{z:.3f}")
        (tmp_path / f"{name}.csv").write_text("\n".join(rows))
    flat = [f"{700_001 + 5 * x},{4_000_001 + 5 * y},321" for x in range(10) for y in range(10)]
    (tmp_path / "flat.csv").write_text("\n".join(["easting,northing,elevation", *flat]))
    (tmp_path / "places.csv").write_text("easting,northing\n700040,4000041\n700060,4000041\n")
    ring = {"type": "Polygon", "coordinates": [[*RING, RING[0]]]}
    aside = [[x - 25, y - 22] for x, y in RING]
    second = {"type": "Polygon", "coordinates": [[*aside, aside[0]]]}
    line = {"type": "LineString", "coordinates": [[700_003, 4_000_003], [700_090, 4_000_080]]}
    write_features(tmp_path / "ring.geojson", ("pad", ring))
    write_features(tmp_path / "two.geojson", ("pad", ring), ("aside", second))
    write_features(tmp_path / "axis.geojson", ("axis", line))
    corners = [
        [700_005, 4_000_040],
        [700_090, 4_000_040],
        [700_090, 4_000_050],
        [700_005, 4_000_050],
    ]
    stream = {"type": "Polygon", "coordinates": [[*corners, corners[0]]]}
    write_features(tmp_path / "stream.geojson", ("stream", stream))
    inner = {"type": "LineString", "coordinates": [[700_005, 4_000_005], [700_040, 4_000_040]]}
    write_features(tmp_path / "cut.geojson", ("axis", inner))
    road = [[700_020, 4_000_020, 322], [700_030, 4_000_020, 322]]
    write_features(tmp_path / "road.geojson", ("axis", {"type": "LineString", "coordinates": road}))
    rows = ["side,name,width,slope,use,ratio", "both,lane,3,-0.02,,", "both,,,,cut,1"]
    (tmp_path / "template.csv").write_text("\n".join([*rows, "both,,,,fill,1"]))
    edits = [{"op": "insert", "points": [[700_004, 4_000_004, 321]]}]
    (tmp_path / "edits.json").write_text(json.dumps(edits))
    return tmp_path


@pytest.fixture
def figures(monkeypatch):
    """Return the list of figures that commands write, filled as they do."""
    from tinsmith.cli import outputs

    drawn, write = [], outputs.write_figure

    def keep(figure, path, *, dpi):
        drawn.append(figure)
        write(figure, path, dpi=dpi // 8)  # their words are compared, no pixels

    monkeypatch.setattr(outputs, "write_figure", keep)
    return drawn


def test_every_command_is_compared():
    assert set(AGREEMENTS) | NO_SURFACE == set(SUMMARIES)


CASES = [
    pytest.param(name, k, marks=[pytest.mark.slow] * (k > 0))
    for name, found in AGREEMENTS.items()
    for k in range(len(found))
]


@pytest.mark.parametrize(("command", "k"), CASES)
def test_all_outputs_of_one_run_agree(command, k, folder, figures):
    require_agreement(AGREEMENTS[command][k](folder, figures))
