"""Reports of volumes say what was measured: read back from the PDF by Poppler."""

import hashlib
import re
import subprocess

import numpy as np
import pytest
from click.testing import CliRunner
from support.printed import read_pdf

import tinsmith as ts
from tinsmith.cli import main

UTM = "EPSG:32616"
EAST, NORTH = 500_000.0, 4_000_000.0


def make_points(seed, size, base):
    rng = np.random.default_rng(seed)
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    xy = size * np.concatenate([corners, rng.random((80, 2))])
    z = base + 2 * np.sin(xy[:, 0] / 17) + rng.uniform(0, 0.3, len(xy))
    return np.column_stack([(xy + np.array([EAST, NORTH])).round(3), z.round(3)])


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    paths = []
    for name, seed, size in (("ground", 1, 120.0), ("design", 2, 90.0)):
        path = folder / f"{name}.csv"
        rows = [f"{x},{y},{z}" for x, y, z in make_points(seed, size, 320.0).tolist()]
        path.write_text("easting,northing,elevation\n" + "\n".join(rows) + "\n")
        paths.append(path)
    return paths


@pytest.fixture(scope="module")
def surfaces(files):
    return [ts.triangulate(ts.read(path, crs=UTM, elevation_unit="m")) for path in files]


def read_text(path):
    """Return the text of a PDF, blanks joined."""
    done = subprocess.run(
        ["pdftotext", "-layout", path, "-"], capture_output=True, text=True, check=True
    )
    return re.sub(r"[ \n]+", " ", done.stdout)


def test_a_report_says_what_the_table_says(surfaces, files, tmp_path):
    how = {"standard_error": 0.03, "other_standard_error": 0.02, "confidence": 0.95}
    made = ts.volume_report(*surfaces, files=files, title="Pit", date="2026-11-27", **how)
    text = read_text(made.save(tmp_path / "pit.pdf")[0])
    table = ts.volume(*surfaces, **how)
    for name in ("cut", "fill", "net", "area", "cut_area", "fill_area", "area_alone"):
        assert f"{table[name][0]:,.2f}" in text, name
    for name in ("cut", "fill", "net"):
        assert f"± {table[f'{name}_error'][0]:,.2f}" in text
        assert f"{table[f'thresholded_{name}'][0]:,.2f}" in text
    assert f"beyond {table['level_of_detection'][0]:.4g} m" in text
    for path, tin in zip(files, surfaces, strict=True):
        assert hashlib.sha256(path.read_bytes()).hexdigest() in text
        assert path.name in text
        assert f"{len(tin.points):,} points" in text
    assert {"Pit", "2026-11-27"} <= set(text.split())
    assert "WGS 84 / UTM zone 16N (EPSG:32616)" in text
    assert f"tinsmith {ts.__version__}" in text
    assert "Accepted by" in text


def test_pages_have_the_size_of_the_paper(surfaces, tmp_path):
    pages = read_pdf(ts.volume_report(*surfaces, paper="A3").save(tmp_path / "pit.pdf")[0])
    assert len(pages) == 3
    for page in pages:
        assert (page.width, page.height) == pytest.approx((297.0, 420.0), abs=1e-3)


def test_words_stay_within_the_border(surfaces, files, tmp_path):
    (file,) = ts.volume_report(*surfaces, files=files).save(tmp_path / "pit.pdf")
    done = subprocess.run(
        ["pdftotext", "-bbox", file, "-"], capture_output=True, text=True, check=True
    )
    boxes = re.findall(r'xMin="(\S+)" yMin="(\S+)" xMax="(\S+)" yMax="(\S+)"', done.stdout)
    mm = np.array(boxes, float) * 25.4 / 72
    assert mm.min() >= 8.0
    assert mm[:, 2].max() <= 210.0 - 8.0
    assert mm[:, 3].max() <= 297.0 - 8.0


def test_the_map_is_true_to_scale(surfaces, tmp_path):
    page = read_pdf(ts.volume_report(*surfaces).save(tmp_path / "pit.pdf")[0])[1]
    scale = float(next(one.text[2:] for one in page.texts if one.text.startswith("1:")))
    paths = [path for own in page.paths.values() for path in own]
    wide = 90.0 * 1000 / scale  # of what both surfaces cover
    rings = [ring for ring in paths if np.ptp(ring[:, 0]) == pytest.approx(wide, abs=0.05)]
    assert any(np.ptp(ring[:, 1]) == pytest.approx(wide, abs=0.05) for ring in rings)


def test_areas_of_the_sections_are_those_of_cross_sections(surfaces, tmp_path):
    made = ts.volume_report(*surfaces)
    text = read_text(made.save(tmp_path / "pit.pdf")[0])
    areas = [
        tuple(map(float, pair)) for pair in re.findall(r"Cut ([\d.]+) m² Fill ([\d.]+) m²", text)
    ]
    assert len(areas) == 2
    tin = made.difference.tin
    corners = tin.points[tin.triangles]
    place = corners[np.argmax(np.abs(corners[:, :, 2].mean(axis=1)))].mean(axis=0)[:2]
    for (cut, fill), axis in zip(areas, ([0, 1], [-1, 0]), strict=True):
        line = np.array([place - np.array(axis) * 0.5, place + np.array(axis) * 0.5])
        table = ts.section_volumes(*surfaces, line, stations=[0.5, 0.6], left=200, right=200)
        assert cut == pytest.approx(table["cut_area"][0], abs=0.006)
        assert fill == pytest.approx(table["fill_area"][0], abs=0.006)


def test_many_regions_go_on_on_further_pages(surfaces, tmp_path):
    rings = {
        f"part {k}": [[EAST + k, NORTH], [EAST + k + 1, NORTH], [EAST + k + 1, NORTH + 80]]
        for k in range(60)
    }
    made = ts.volume_report(*surfaces, regions=rings)
    text = read_text(made.save(tmp_path / "pit.pdf")[0])
    assert len(made) > 3
    assert all(f"part {k} " in text for k in range(60))
    assert text.count("Accepted by") == 1
    assert f"Page {len(made)} of {len(made)}" in text


def test_a_level_has_its_name(surfaces, tmp_path):
    text = read_text(ts.volume_report(surfaces[0], base=320.5).save(tmp_path / "pit.pdf")[0])
    assert "level 320.500 m" in text
    assert f"{ts.volume(surfaces[0], base=320.5)['cut'][0]:,.2f}" in text


def test_notes_of_surfaces_stand_on_the_page(surfaces, tmp_path):
    noted = surfaces[0].with_notes(["One shot was left out."])
    text = read_text(ts.volume_report(noted, base=320.5).save(tmp_path / "pit.pdf")[0])
    assert "One shot was left out." in text


def test_the_same_surfaces_make_the_same_bytes(surfaces, files, tmp_path):
    saved = [
        ts.volume_report(*surfaces, files=files).save(tmp_path / f"{k}.pdf")[0].read_bytes()
        for k in range(2)
    ]
    assert saved[0] == saved[1]


def test_what_cannot_be_is_refused(surfaces, files, tmp_path):
    with pytest.raises(ts.OptionError, match="number of files 1: it must be 2"):
        ts.volume_report(*surfaces, files=files[:1])
    with pytest.raises(ts.ReadError, match=r"none\.csv"):
        ts.volume_report(surfaces[0], base=320, files=tmp_path / "none.csv")
    with pytest.raises(ts.OptionError, match="paper"):
        ts.volume_report(*surfaces, paper="B9")
    with pytest.raises(ts.RenderError, match=r"a report to .*\.pdf"):
        ts.volume_report(*surfaces).save(tmp_path / "pit.svg")
    far = ts.triangulate(surfaces[1].points + np.array([1e5, 0, 0]), crs=UTM, elevation_unit="m")
    with pytest.raises(ts.PointsError, match="overlap"):
        ts.volume_report(surfaces[0], far)


def run(*words):
    return CliRunner().invoke(main, [str(one) for one in words])


def test_the_command_writes_the_report_of_the_library(surfaces, files, tmp_path):
    pdf, table = tmp_path / "pit.pdf", tmp_path / "pit.csv"
    options = ("--crs", UTM, "--elevation-unit", "m", "--standard-error", 0.05)
    done = run("volume", *files, *options, "--date", "2026-11-27", "-o", pdf, "-o", table)
    assert done.exit_code == 0, done.output
    assert "3 pages" in done.output
    own = ts.volume_report(
        *surfaces, files=files, standard_error=0.05, date="2026-11-27",
        title="Volumes: ground to design",
    ).save(tmp_path / "own.pdf")[0]  # fmt: skip
    assert own.read_bytes() == pdf.read_bytes()
    cut = np.genfromtxt(table, delimiter=",", skip_header=1)[1]
    assert f"{cut:,.2f}" in read_text(pdf)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--base", 320, "-o", "a.csv", "--date", "today"], "--date is for a report"),
        (["--stage-storage", "--interval", 1, "-o", "a.pdf"], "a.pdf"),
        (["--base", 320, "-o", "a.svg"], "a.svg"),
    ],
)
def test_reports_that_cannot_be_are_refused(words, said, files):
    done = run("volume", files[0], "--crs", UTM, *words)
    assert done.exit_code in (1, 2), done.output
    assert said in done.output
