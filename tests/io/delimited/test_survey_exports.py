"""Layouts of real survey exports, each plain to a person: all must be read, and as they are."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyproj
import pytest

import tinsmith as ts

EXPORTS = Path(__file__).with_name("survey_exports.txt")
PLACES = {
    "local": (None, 5_000, 1_000, 98),
    "tennessee": ("EPSG:32616", 752_700, 4_024_240, 322),
    "nashville": ("EPSG:2274", 1_745_000, 665_000, 520),
    "texas": ("EPSG:2277", 3_115_000, 10_070_000, 550),
    "phoenix": ("EPSG:2223", 650_000, 890_000, 1_090),
    "toronto": ("EPSG:2952", 313_000, 4_835_000, 92),
    "quebec": ("EPSG:2949", 246_000, 5_186_000, 61),
    "melbourne": ("EPSG:7855", 321_000, 5_813_000, 41),
    "wellington": ("EPSG:2193", 1_749_000, 5_428_000, 22),
    "birmingham": ("EPSG:27700", 407_000, 287_000, 120),
    "dublin": ("EPSG:2157", 715_000, 734_000, 14),
    "nairobi": ("EPSG:32737", 257_000, 9_857_000, 1_702),
    "lagos": ("EPSG:26331", 543_000, 713_000, 8),
    "cairo": ("EPSG:32636", 330_000, 3_325_000, 24),
    "munich": ("EPSG:25832", 691_000, 5_335_000, 519),
    "munichgk": ("EPSG:31468", 4_468_000, 5_335_000, 519),
    "vienna": ("EPSG:31256", 2_300, 340_700, 171),
    "bern": ("EPSG:2056", 2_600_100, 1_199_800, 553),
    "bern03": ("EPSG:21781", 600_100, 199_800, 553),
    "luxembourg": ("EPSG:2169", 77_000, 75_000, 280),
    "paris": ("EPSG:2154", 652_000, 6_862_000, 36),
    "nantes": ("EPSG:3947", 1_355_000, 6_236_000, 19),
    "brussels": ("EPSG:31370", 149_000, 170_500, 25),
    "brussels08": ("EPSG:3812", 649_000, 670_500, 25),
    "amersfoort": ("EPSG:28992", 155_100, 463_200, 3),
    "madrid": ("EPSG:25830", 440_000, 4_474_000, 652),
    "lisbon": ("EPSG:3763", -87_500, -103_700, 61),
    "saopaulo": ("EPSG:31983", 333_000, 7_395_000, 761),
    "lima": ("EPSG:32718", 280_000, 8_665_000, 151),
    "santiago": ("EPSG:32719", 346_000, 6_297_000, 571),
    "mexico": ("EPSG:32614", 486_000, 2_148_000, 2_241),
    "bogota": ("EPSG:9377", 4_880_000, 2_075_000, 2_601),
    "argentina": ("EPSG:5347", 5_637_000, 6_170_000, 25),
    "rome": ("EPSG:32633", 290_500, 4_640_300, 51),
    "roma40": ("EPSG:3004", 2_310_500, 4_640_300, 51),
    "copenhagen": ("EPSG:25832", 724_300, 6_175_800, 11),
    "oslo": ("EPSG:25832", 598_000, 6_643_000, 92),
    "oslontm": ("EPSG:5110", 114_000, 1_212_000, 92),
    "stockholm": ("EPSG:3006", 674_000, 6_580_000, 31),
    "stockholm18": ("EPSG:3011", 153_000, 6_580_000, 31),
    "rt90": ("EPSG:3021", 1_628_000, 6_580_000, 31),
    "helsinki": ("EPSG:3067", 385_000, 6_672_000, 21),
    "reykjavik": ("EPSG:3057", 357_000, 407_000, 33),
    "tallinn": ("EPSG:3301", 542_000, 6_589_000, 33),
    "riga": ("EPSG:3059", 506_000, 312_000, 9),
    "vilnius": ("EPSG:3346", 582_000, 6_061_000, 112),
    "warsaw": ("EPSG:2178", 7_501_000, 5_788_000, 103),
    "krovak": ("EPSG:5514", -743_000, -1_043_000, 252),
    "prague": ("EPSG:32633", 458_000, 5_548_000, 252),
    "bratislava": ("EPSG:32633", 668_000, 5_334_000, 141),
    "ljubljana": ("EPSG:3794", 462_000, 101_000, 301),
    "zagreb": ("EPSG:3765", 459_000, 5_074_000, 121),
    "belgrade": ("EPSG:32634", 457_000, 4_963_000, 118),
    "budapest": ("EPSG:23700", 650_200, 240_100, 112),
    "bucharest": ("EPSG:3844", 586_100, 330_100, 91),
    "sofia": ("EPSG:7801", 322_000, 4_731_000, 563),
    "moscow": ("EPSG:28407", 7_413_000, 6_180_000, 152),
    "kyiv": ("EPSG:32636", 325_000, 5_590_000, 181),
    "athens": ("EPSG:2100", 476_000, 4_204_000, 102),
    "istanbul": ("EPSG:5254", 416_000, 4_540_000, 54),
    "telaviv": ("EPSG:2039", 180_000, 665_000, 32),
    "riyadh": ("EPSG:32638", 671_000, 2_734_000, 612),
    "tokyo": ("EPSG:6677", -12_100, -35_100, 13),
    "wuhan": ("EPSG:4547", 505_000, 3_380_000, 31),
    "taipei": ("EPSG:3826", 305_000, 2_770_000, 16),
    "hongkong": ("EPSG:2326", 836_000, 819_000, 6),
    "seoul": ("EPSG:5186", 200_300, 550_400, 42),
    "jakarta": ("EPSG:32748", 702_000, 9_312_000, 21),
    "malaysia": ("EPSG:3168", 410_000, 350_000, 62),
    "hanoi": ("EPSG:3405", 588_000, 2_325_000, 12),
    "bangkok": ("EPSG:32647", 665_000, 1_520_000, 4),
    "delhi": ("EPSG:32643", 716_000, 3_168_000, 216),
    "manila": ("EPSG:32651", 282_000, 1_614_000, 9),
    "singapore": ("EPSG:3414", 29_000, 31_000, 15),
}


class Export(NamedTuple):
    """A layout, with the place that its points lie in."""

    title: str
    place: str
    head: tuple[str, ...]
    row: str


def list_exports() -> list[Export]:
    text = EXPORTS.read_text(encoding="utf-8").replace("\\t", "\t")
    blocks = text.split("\n== ")[1:]
    found = []
    for block in blocks:
        title, *lines = block.rstrip("\n").split("\n")
        name, _, place = title.rpartition(" | ")
        found.append(Export(name, place, tuple(lines[:-1]), lines[-1]))
    return found


def make_points(place: str) -> np.ndarray:
    _, e, n, z = PLACES[place.lstrip("-")]
    rows = [(7.135 * i + i * 37 % 11, 5.217 * (i * 7 % 12), 0.31 * (i * 5 % 9)) for i in range(12)]
    return np.round(np.array([e, n, z]) + rows, 3)


def fill(export: Export, points: np.ndarray) -> str:
    """Write the rows of an export below what stands above them."""
    crs = PLACES[export.place.lstrip("-")][0]
    degrees = np.zeros((len(points), 2))
    if "{lon}" in export.row:
        transform = pyproj.Transformer.from_crs(crs, "EPSG:4326", always_xy=True).transform
        degrees = np.column_stack(transform(points[:, 0], points[:, 1]))
    codes, texts = ("GS", "EP", "MH"), ("top of bank", "tree 12", "kerb")
    rows = []
    for i, (point, (lon, lat)) in enumerate(zip(points, degrees, strict=True)):
        e, n, z = (f"{value:.3f}" for value in point)
        commas = {f"{k}c": v.replace(".", ",") for k, v in zip("enz", (e, n, z), strict=True)}
        words = {"p": i + 1, "c": codes[i % 3], "t": texts[i % 3]}
        degree = {"lon": f"{lon:.9f}", "lat": f"{lat:.9f}"}
        rows.append(export.row.format(e=e, n=n, z=z, **commas, **words, **degree))
    return "\n".join([*export.head, *rows]) + "\n"


@pytest.mark.parametrize("export", list_exports(), ids=lambda export: export.title)
def test_the_layout_is_read(tmp_path, export):
    points = make_points(export.place)
    path = tmp_path / "export.txt"
    path.write_text(fill(export, points), encoding="utf-8")
    crs = None if export.place.startswith("-") else PLACES[export.place][0]
    survey = ts.read(path, crs=crs)
    assert survey.points == pytest.approx(points, abs=1e-3 if "{lon}" in export.row else 1e-9)


def test_there_are_many_layouts():
    assert len(list_exports()) >= 140
