"""``--no-check-crs`` takes what contradicts its CRS, in every command that reads."""

import inspect

import click
import numpy as np
import pytest
from support.commands import run

import tinsmith as ts
from tinsmith.cli import main
from tinsmith.cli.command_list import SUMMARIES

# A new command, product or format must not be forgotten, whatever the walk over all of them takes.
pytestmark = [pytest.mark.every_case, pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")]

CRS = "EPSG:32616"
RNG = np.random.default_rng(4)
SITE = np.column_stack([RNG.uniform(0, 60, (30, 2)), RNG.uniform(0, 3, 30)])
SITE += [752_700.0, 4_024_200.0, 300.0]
COMMANDS = {
    "build": "build POINTS -o OUT.ply",
    "info": "info TIN",
    "check": "check TIN",
    "inspect": "inspect POINTS -o OUT.csv",
    "view": "view TIN -o OUT.png",
    "compare": "compare POINTS",
    "refine": "refine TIN --min-angle 20 -o OUT.ply",
    "simplify": "simplify TIN --tolerance 0.1 -o OUT.ply",
    "grade": "grade TIN --pad PAD --elevation 305 --cut-slope 1 --fill-slope 1 -o OUT.ply",
    "corridor": "corridor TIN ROAD TEMPLATE -o OUT.ply",
    "paste": "paste TIN PATCH -o OUT.ply",
    "merge": "merge PATCH TIN -o OUT.ply",
    "coregister": "coregister TIN TIN2 --spacing 2 -o OUT.ply",
    "riverbed": "riverbed SECTIONS AXIS --spacing 5 -o OUT.ply",
    "hydroflatten": "hydroflatten TIN --stream STREAM --downstream along --spacing 5 -o OUT.ply",
    "clip": "clip TIN --by PAD -o OUT.ply",
    "ground": "ground POINTS -o OUT.las",
    "edit": "edit TIN EDITS -o OUT.ply",
    "convert": "convert TIN -o OUT.ply",
    "contours": "contours TIN --interval 1 -o OUT.gpkg",
    "slope": "slope TIN -o OUT.gpkg",
    "hillshade": "hillshade TIN --spacing 5 -o OUT.tif",
    "profile": "profile TIN --line LINE -o OUT.csv",
    "volume": "volume TIN --base 300 -o OUT.csv",
    "sections": "sections TIN TIN2 --line LINE --interval 3 --width 2 -o OUT.csv",
    "stakeout": "stakeout TIN --at QUERY -o OUT.csv",
    "diff": "diff TIN TIN2 -o OUT.csv",
    "drape": "drape TIN LINE -o OUT.gpkg",
    "interpolate": "interpolate TIN --at QUERY -o OUT.csv",
    "raster": "raster TIN --spacing 5 -o OUT.tif",
    "flow": "flow TIN --find pits -o OUT.csv",
    "sight": "sight TIN --from Y X --eye-height 2 -o OUT.csv",
    "plan": "plan TIN -o OUT.png",
}
READS_NOTHING = {"formats", "completion", "alignment"}  # or an axis, which has no area to be in


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return files whose northing comes first; none names its CRS."""
    folder = tmp_path_factory.mktemp("exchanged")
    points = SITE[:, [1, 0, 2]]
    x, y = points[:, :2].mean(axis=0)
    ring = np.array([[x - 5, y - 5], [x + 5, y - 5], [x + 5, y + 5], [x - 5, y + 5]])
    ring = np.column_stack([[*ring, ring[0]], np.full(5, 304.0)])
    patch = ts.triangulate(np.column_stack([ring[:4, :2], [301.0, 301.5, 302.0, 301.0]]))
    made = {
        "POINTS": folder / "points.las",
        "TIN": folder / "tin.ply",
        "TIN2": folder / "other.ply",
        "PATCH": folder / "patch.ply",
        "LINE": folder / "line.fgb",
        "ROAD": folder / "road.fgb",
        "TEMPLATE": folder / "template.csv",
        "PAD": folder / "pad.fgb",
        "STREAM": folder / "stream.fgb",
        "SECTIONS": folder / "sections.fgb",
        "AXIS": folder / "axis.fgb",
        "EDITS": folder / "edits.json",
        "QUERY": folder / "query.csv",
    }
    ts.write(ts.Survey(points=points), made["POINTS"])
    for name in ("TIN", "TIN2"):
        ts.write(ts.triangulate(points), made[name])
    ts.write(patch, made["PATCH"])
    ts.write(ts.Features.of_lines(ring[[0, 2]], [0, 2]), made["LINE"])
    ts.write(ts.Features.of_polygons(ring, [0, 5], [0, 1]), made["PAD"])
    road = np.column_stack([ring[[0, 2]][:, :2], [304.0, 304.0]])
    ts.write(ts.Features.of_lines(road, [0, 2]), made["ROAD"])
    stream = ring[:, :2] * [1.0, 0.2] + [0.0, 0.8 * y]
    ts.write(ts.Features.of_polygons(stream, [0, 5], [0, 1]), made["STREAM"])
    ts.write(ts.Features.of_lines([[x - 9, y], [x + 9, y]], [0, 2]), made["AXIS"])
    sections = [[x + a, y + b, 304] for a in (-5, 5) for b in (-3, 0, 3)]
    ts.write(ts.Features.of_lines(sections, [0, 3, 6]), made["SECTIONS"])
    made["TEMPLATE"].write_text(
        "side,name,width,slope,use,ratio\nboth,lane,1,,,\nboth,,,,cut,1\nboth,,,,fill,1\n"
    )
    made["EDITS"].write_text('[{"op": "remove", "vertices": [4]}]')
    made["QUERY"].write_text(f"easting,northing\n{x},{y}\n")
    return {name: str(path) for name, path in made.items()} | {"X": str(y), "Y": str(x)}


def test_every_command_that_reads_is_here():
    assert {*COMMANDS} | READS_NOTHING == {*SUMMARIES}
    with click.Context(main) as context:
        for name in COMMANDS:
            command = main.get_command(context, name)
            flags = [flag for one in command.params for flag in one.secondary_opts]
            assert "--no-check-crs" in flags, name


@pytest.mark.parametrize("name", COMMANDS)
def test_exchanged_coordinates_are_taken_only_where_it_is_asked(files, tmp_path, name):
    words = COMMANDS[name].replace("OUT", str(tmp_path / "out")).split()
    arguments = [files.get(word, word) for word in words]
    refused = run(*arguments, "--crs", CRS)
    assert refused.exit_code == 1, refused.output
    assert "--no-check-crs takes them as they are" in refused.output, refused.output
    assert list(tmp_path.iterdir()) == []
    taken = run(*arguments, "--crs", CRS, "--no-check-crs")
    if name == "plan":  # lengths there are no lengths on the ground
        assert "no scale would hold" in taken.output
        return
    assert taken.exit_code == 0, taken.output
    assert "in the other order" in taken.output


def test_the_option_of_the_library_has_the_same_default():
    assert inspect.signature(ts.read).parameters["check_crs"].default is True
