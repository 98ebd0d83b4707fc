"""Make the pictures of docs/plan.md: strips along a valley, a title block, stations of a road.

Run ``python docs/make_plan.py [FOLDER]``; needs the extras "plot" and "raster".
"""

import sys
import tempfile
from pathlib import Path

import shapely
from PIL import Image

import tinsmith as ts

FOLDER = Path(__file__).parent
SAMPLES = FOLDER.parent / "sample_data"
WAY = [(739000, 4008000), (744000, 4013000), (746500, 4018500), (751500, 4022500),
       (752500, 4028500), (758500, 4033500)]  # fmt: skip
WIDTH = 1500.0
ROAD = [(752645, 4024255), (752760, 4024275), (752888, 4024270)]
DPI = 84
COLORS = 64


def main(folder: Path = FOLDER) -> None:
    """Write the pictures."""
    draw_strips(folder)
    draw_title_block(folder)
    draw_stations(folder)


def read_site() -> tuple[ts.Survey, ts.TIN]:
    """Return the sample site."""
    survey = ts.lines_from_codes(
        ts.read(SAMPLES / "site_survey.csv", crs="EPSG:32616", elevation_unit="m")
    )
    return survey, ts.triangulate(survey, max_edge=20.0)


def draw_stations(folder: Path) -> None:
    """Write plan-stations.png: a sheet along the road."""
    _, tin = read_site()
    road = ts.Alignment.from_points(ROAD, radii=[150.0], crs="EPSG:32616")
    made = ts.plan(
        tin, axis=road, station_interval=10.0, station_range=(40.0, 200.0), layout="strips",
        scale=250, paper="A3", interval=0.5, title="Road",
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as scratch:
        sheet = Image.open(made.save(Path(scratch, "plan.png"), dpi=DPI)[1]).convert("RGB")
    sheet.quantize(COLORS, dither=Image.Dither.NONE).save(
        folder / "plan-stations.png", optimize=True
    )


def draw_title_block(folder: Path) -> None:
    """Write plan-title-block.png: a corner of a sheet with labels of points, spot heights."""
    survey, tin = read_site()
    made = ts.plan(
        tin, survey=survey, scale=500, paper="A1", interval=0.5, points="numbers,codes",
        label_size=1.4, spots=25.0, decimals=1, title="Site survey",
        title_block=SAMPLES / "title_block.toml",
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as scratch:
        (file,) = made.save(Path(scratch, "plan.png"), dpi=DPI)
        sheet = Image.open(file).convert("RGB")
    width, height = sheet.size
    corner = sheet.crop((int(0.42 * width), int(0.46 * height), width - 20, height - 20))
    corner.quantize(COLORS, dither=Image.Dither.NONE).save(
        folder / "plan-title-block.png", optimize=True
    )


def draw_strips(folder: Path) -> None:
    """Write plan-strips.png: the index sheet, and one of the strips."""
    survey = ts.read(SAMPLES / "jacksboro.tif")
    corridor = shapely.LineString(WAY).buffer(WIDTH / 2, cap_style="flat").simplify(5.0)
    tin = ts.triangulate(survey, boundary=[corridor])
    made = ts.plan(
        tin,
        scale=25_000,
        paper="A4",
        layout="strips",
        interval=20,
        title="A corridor near Jacksboro",
        date="2026-11-22",
    )
    with tempfile.TemporaryDirectory() as scratch:
        files = made.save(Path(scratch, "plan.png"), dpi=DPI)
        pictures = [Image.open(file).convert("RGB") for file in (files[0], files[2])]
        sheet = Image.new("RGB", (sum(one.width for one in pictures) + 12, pictures[0].height))
        sheet.paste("#999999", (0, 0, *sheet.size))
        sheet.paste(pictures[0], (0, 0))
        sheet.paste(pictures[1], (pictures[0].width + 12, 0))
    sheet.quantize(COLORS, dither=Image.Dither.NONE).save(folder / "plan-strips.png", optimize=True)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
