"""Several files as one survey: joined, in one CRS and unit, with what is doubtful told."""

from __future__ import annotations

import gzip
import json

import numpy as np
import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith.cli import main
from tinsmith.io.reprojection.joining import join_surveys

HEAD = "number,easting,northing,elevation,code\n"


def write_csv(path, rows, head=HEAD):
    path.parent.mkdir(exist_ok=True)
    path.write_text(head + "".join(",".join(map(str, row)) + "\n" for row in rows))
    return path


@pytest.fixture
def files(tmp_path):
    one = write_csv(
        tmp_path / "a.csv",
        [
            (1, 500000, 4000000, 10, "EP1"),
            (2, 500010, 4000000, 11, "EP1"),
            (3, 5e5, 4000010, 12, ""),
        ],
    )
    other = write_csv(
        tmp_path / "b.csv",
        [(2, 500010, 4000000, 11.5, "EP1"), (20, 500020, 4000000, 13, "EP1")],
    )
    return one, other


def make(points, **more):
    return ts.Survey(points=np.array(points, float), **more)


def test_points_and_attributes_are_those_of_all_in_order(files):
    survey = ts.read(list(files), crs="EPSG:32616")
    apart = [ts.read(file, crs="EPSG:32616") for file in files]
    assert survey.points.tolist() == [*apart[0].points.tolist(), *apart[1].points.tolist()]
    assert survey.attributes["number"].tolist() == [1, 2, 3, 2, 20]
    assert survey.attributes["source_file"].tolist() == ["a.csv"] * 3 + ["b.csv"] * 2
    assert survey.crs == "EPSG:32616"
    assert survey.source == "a.csv, b.csv"
    assert ts.read([files[0]], crs="EPSG:32616").attributes.keys() == apart[0].attributes.keys()


def test_points_at_one_place_and_numbers_in_several_files_are_told(files):
    told = " ".join(ts.read(files).notes)
    assert "1 point of one file stands where a point of another does" in told
    assert "'b.csv' and 'a.csv' at x 500010, y 4000000): elevations differ by up to 0.5." in told
    assert "1 point number is in several files (first: 2 in 'a.csv' and 'b.csv')" in told


def test_lines_of_codes_end_with_their_file(files):
    made = ts.lines_from_codes(ts.read(files))
    assert [line.coords[:, 0].tolist() for line in made.breaklines] == [
        [500000, 500010],
        [500010, 500020],
    ]
    assert "those of one name in several files (EP1) were not joined" in " ".join(made.notes)
    assert len(made) == 5


def test_findings_of_codes_name_rows_of_the_whole_survey(tmp_path):
    one = write_csv(tmp_path / "a.csv", [(1, 0, 0, 1, "GS"), (2, 9, 0, 1, "GS"), (3, 0, 9, 1, "")])
    other = write_csv(
        tmp_path / "b.csv", [(1, 50, 0, 1, "GS"), (2, 51, 0, 1, "EP1"), (3, 60, 0, 1, "FL1"),
                             (4, 70, 0, 1, "FL1")],
    )  # fmt: skip
    made = ts.lines_from_codes(ts.read([one, other]))
    assert [finding.rows for finding in made.findings] == [(4,)]
    assert [line.name for line in made.breaklines] == ["FL1"]
    with pytest.raises(ts.LinesError, match="No description begins"):
        ts.lines_from_codes(ts.read([one, write_csv(tmp_path / "c.csv", [(1, 0, 0, 1, "GS")])]))


def test_a_folder_of_files_is_one_survey(files, tmp_path):
    (tmp_path / "c.csv.gz").write_bytes(gzip.compress((HEAD + "9,1,2,3,\n").encode()))
    (tmp_path / "site.prj").write_text("nothing that is read")
    (tmp_path / ".hidden.csv").write_text("x")
    survey = ts.read(tmp_path)
    assert len(survey) == 6
    assert set(survey.attributes["source_file"]) == {"a.csv", "b.csv", "c.csv.gz"}
    assert survey.source == tmp_path.name
    assert f"In '{tmp_path.name}' 3 files were read, and not site.prj." in survey.notes


def test_a_folder_of_one_file_says_so_in_the_singular(tmp_path):
    (tmp_path / "a.csv").write_text(HEAD + "9,1,2,3,\n")
    (tmp_path / "site.prj").write_text("nothing that is read")
    assert f"In '{tmp_path.name}' 1 file was read, and not site.prj." in ts.read(tmp_path).notes


def test_a_folder_of_several_formats_is_refused_until_one_is_named(files, tmp_path):
    survey = ts.read(files[0], crs="EPSG:32616")
    ts.write(ts.triangulate(survey), tmp_path / "t.gpkg")  # holds no points
    ts.write(survey, tmp_path / "p.fgb")
    with pytest.raises(ts.ReadError, match=r"several formats: 'a.csv' \(delimited\), 'p.fgb'"):
        ts.read(tmp_path)
    assert len(ts.read(tmp_path, format="delimited")) == 5
    empty = tmp_path / "empty"
    empty.mkdir()
    with pytest.raises(ts.ReadError, match="is a folder: name a file in it"):
        ts.read(empty)


def test_surveys_in_several_crs_are_refused_or_brought_to_the_one_wanted(tmp_path):
    points = np.array([[500000.0, 4000000, 10], [500010, 4000000, 11], [500000, 4000010, 12]])
    here = make(points, crs="EPSG:32616")
    paths = [
        ts.write(here, tmp_path / "a.fgb"),
        ts.write(ts.reproject(here, "EPSG:32617"), tmp_path / "b.fgb"),
    ]
    with pytest.raises(ts.CrsError, match=r"'a.fgb' and 'b.fgb' are not in one CRS: EPSG:32616 "):
        ts.read(paths)
    survey = ts.read(paths, crs="EPSG:32616")
    order = np.lexsort(survey.points.T.round(3))
    assert np.allclose(survey.points[order][::2], survey.points[order][1::2], rtol=0, atol=1e-3)
    with pytest.raises(ts.CrsError, match="EPSG:32616 and none is known"):
        join_surveys([here, make(points)], ["a", "b"])


def test_elevations_in_several_units_become_those_of_the_first():
    points = [[0.0, 0, 10], [4, 0, 11], [0, 4, 12]]
    metres = make(points, crs="EPSG:32616", elevation_unit="m")
    ring = [[0, 0], [1, 0], [0, 1]]
    feet = make(
        points,
        crs="EPSG:32616",
        elevation_unit="ft",
        breaklines=[ts.Breakline([[0, 0, 10], [4, 0, 20]], name="kerb", priority=3)],
        water=[ts.Water(ring, 100, name="pond")],
        holes=[[[0, 0, 5], [1, 0, 5], [0, 1, 5]]],
        boundary=[ring],
    )
    joined = join_surveys([metres, feet], ["m.csv", "ft.csv"])
    assert np.allclose(joined.points[:, 2], [10, 11, 12, 3.048, 3.3528, 3.6576], rtol=1e-15)
    assert joined.elevation_unit == ts.Unit.of("m")
    (line,) = joined.breaklines
    assert np.allclose(line.coords, [[0, 0, 3.048], [4, 0, 6.096]], rtol=1e-15)
    assert (line.name, line.priority, line.kind) == ("kerb", 3, "hard")
    assert joined.water[0].z == pytest.approx(30.48, rel=1e-15)
    assert np.allclose(joined.holes[0][:, 2], 1.524, rtol=1e-15)
    assert np.shape(joined.boundary[0]) == (3, 2)
    assert "elevations of 'ft.csv' were converted from foot to metre" in " ".join(joined.notes)
    for unit, error, words in (
        ("ft", ts.ReadError, "'b' are in foot and others in metre, and no CRS"),
        (None, ts.CrsError, "unit of the elevations of 'b' is not known"),
    ):
        pair = [make(points, elevation_unit="m"), make(points, elevation_unit=unit)]
        with pytest.raises(error, match=words):
            join_surveys(pair, ["a", "b"])


def test_attributes_that_some_lack_and_of_several_types():
    one = make(
        [[0, 0, 1], [1, 0, 1]],
        attributes={"number": [1, 2], "weight": [1, 2], "code": ["a", "b"], "own": [True, False]},
        notes=["said by both", "said by one"],
        skipped={"void": 2},
        skipped_lines={"void": (3, 4)},
    )
    other = make(
        [[5, 5, 1]],
        attributes={"number": ["2A"], "weight": [0.5], "late": ["x"]},
        notes=["said by both"],
        skipped={"void": 1},
        skipped_lines={"void": (9,)},
        findings=[ts.base.types.Finding("odd", (0,), "Odd.")],
    )
    joined = join_surveys([one, other], ["a", "b"])
    found = {name: column.tolist() for name, column in joined.attributes.items()}
    assert found == {
        "number": [1, 2, "2A"],
        "weight": [1.0, 2.0, 0.5],
        "code": ["a", "b", ""],
        "own": [True, False, None],
        "late": ["", "", "x"],
        "source_file": ["a", "a", "b"],
    }
    assert joined.notes[:2] == ["said by both", "'a': said by one"]
    assert joined.skipped == {"void": 3}
    assert joined.skipped_lines == {"void of a": (3, 4), "void of b": (9,)}
    assert joined.findings[0].rows == (2,)


def test_what_cannot_be_joined_is_refused(files, tmp_path):
    tin = ts.write(ts.triangulate(ts.read(files[0])), tmp_path / "t.ply")
    for paths, words in (
        ([files[0], tin], "holds a TIN, whose triangles cannot be joined"),
        ([files[0], tmp_path / "none.csv"], "There is no file"),
    ):
        with pytest.raises(ts.ReadError, match=words):
            ts.read(paths)
    with pytest.raises(ts.OptionError, match="a list of at least one"):
        ts.read([])
    ring = [[0, 0, 1], [4, 0, 1], [0, 4, 1]]
    holed = make(ring, extent=[np.array(ring, float)])
    with pytest.raises(ts.ReadError, match="'a' has voids"):
        join_surveys([holed, make(ring)], ["a", "b"])


def test_shared_places_against_a_plain_loop():
    rng = np.random.default_rng(3)
    for _ in range(40):
        parts = [make(rng.integers(0, 4, (rng.integers(1, 9), 3))) for _ in range(3)]
        seen, count = {}, 0
        for number, part in enumerate(parts):
            for x, y, _ in part.points.tolist():
                count += seen.setdefault((x, y), number) != number
        told = [
            note for note in join_surveys(parts, ["a", "b", "c"]).notes if "of one file" in note
        ]
        assert (f"{count:,} point" in told[0]) if count else not told


def test_the_command_line_takes_several_files(files, tmp_path):
    paths = [str(file) for file in files]
    out = str(tmp_path / "t.gpkg")
    built = ["build", *paths, "--crs", "EPSG:32616", "--codes", "-o", out, "--json"]
    done = CliRunner().invoke(main, built)
    assert done.exit_code == 0, done.output
    record = json.loads(done.stdout)
    assert record["input"] == paths
    assert record["survey"]["points"] == 5
    tin = ts.read(out)
    assert len(tin.lines) == 2
    assert tin.attributes["source_file"].tolist() == ["a.csv"] * 3 + ["b.csv"]
    told = CliRunner().invoke(main, ["info", *paths, "--json"])
    assert json.loads(told.stdout)["points"] == 5
    done = CliRunner().invoke(main, ["build", *paths, "-o", paths[1]])
    assert done.exit_code == 2
    assert "cannot be the output too" in done.output
    done = CliRunner().invoke(main, ["info", paths[0], out])
    assert done.exit_code == 1
    assert "holds a TIN, whose triangles cannot be joined" in done.output
