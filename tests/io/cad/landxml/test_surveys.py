"""LandXML as surveys: survey points, and the source data of surfaces."""

import numpy as np
import pytest

import tinsmith as ts

from .test_reading import CORNERS, METRIC, document, points_of, refused, surface, write

__all__ = ["write"]

POINTS = """<CgPoints name="shots">
<CgPoint name="7" code="EP1" desc="edge of pavement">100 200 5.5</CgPoint>
<CgPoint name="8" code="EP1">101 202 5.25</CgPoint>
<CgPoint name="9" code="BM">103 200</CgPoint>
<CgPoint name="10" code="CL" DTMAttribute="donotinclude">104 200 0</CgPoint>
<CgPoints name="inner"><CgPoint name="11">105 205 6</CgPoint></CgPoints>
<CgPoint pntRef="7"/>
</CgPoints>"""


def source(inner):
    return f"<SourceData>{inner}</SourceData>"


def only_source(inner, points=""):
    text = f'<Surface name="EG">{source(inner)}</Surface>'
    return document(text, points=points)


def test_survey_points_with_names_codes_and_descriptions(write):
    survey = ts.read(write(document(points=POINTS)))
    assert survey.points.tolist() == [[200, 100, 5.5], [202, 101, 5.25], [205, 105, 6]]
    assert survey.attributes["number"].tolist() == ["7", "8", "11"]
    assert survey.attributes["description"].tolist() == ["edge of pavement", "", ""]
    assert survey.attributes["code"].tolist() == ["EP1", "EP1", ""]
    assert survey.attributes["group"].tolist() == ["shots", "shots", "inner"]
    assert survey.skipped == {
        "references to other points": 1,
        "points without elevation": 1,
        "points not for the surface": 1,
    }
    assert survey.elevation_unit.name == "metre"


def test_a_code_is_the_description_where_there_is_no_other(write):
    text = document(points=POINTS.replace(' desc="edge of pavement"', ""))
    assert ts.read(write(text)).attributes["description"].tolist() == ["EP1", "EP1", ""]


def test_a_surface_comes_before_points_and_both_can_be_chosen(write):
    path = write(document(surface(), points=POINTS))
    tin = ts.read(path)
    assert len(tin.triangles) == 2
    assert "6 survey points" in " ".join(tin.report.notes)
    assert len(ts.read(path, content="points")) == 3
    refused("no surface with source data", path, content="source")
    refused("Invalid content", path, error=ts.OptionError, content="all")


LINES = """<Breaklines>
<Breakline brkType="standard" name="kerb"><PntList3D>0 0 1 2 2 3 4 4 3</PntList3D></Breakline>
<Breakline brkType="nondestructive"><PntList3D>0 1 0 2 1 0</PntList3D></Breakline>
<Breakline brkType="proximity" desc="ditch"><PntList2D>0 2 1 2</PntList2D></Breakline>
<RetWall><RetWallPnt height="1" offset="1">0 0 1</RetWallPnt></RetWall>
</Breaklines><Boundaries>
<Boundary bndType="outer" edgeTrim="true"><PntList2D>0 0 0 9 9 9 9 0</PntList2D></Boundary>
<Boundary bndType="void" edgeTrim="true"><PntList3D>1 1 5 1 6 5 6 6 5 6 1 5</PntList3D></Boundary>
<Boundary bndType="island" edgeTrim="false"><PntList2D>2 2 2 3 3 3</PntList2D></Boundary>
</Boundaries>"""


def test_source_data_become_lines_and_rings(write):
    data = "<DataPoints><PntList3D>0 0 1 0 9 2 9 9 3 9 0 4</PntList3D></DataPoints>"
    survey = ts.read(write(only_source(LINES + data)))
    assert survey.points.tolist() == [[0, 0, 1], [9, 0, 2], [9, 9, 3], [0, 9, 4]]
    kerb, draped, ditch = survey.breaklines
    assert (kerb.name, kerb.coords.tolist()) == ("kerb", [[0, 0, 1], [2, 2, 3], [4, 4, 3]])
    assert draped.is_draped
    assert (ditch.name, ditch.coords.tolist()) == ("ditch", [[2, 0], [2, 1]])
    assert survey.boundary[0].tolist() == [[0, 0], [9, 0], [9, 9], [0, 9]]
    ((void, island),) = survey.holes
    assert (len(void), len(island)) == (4, 3)
    told = " ".join(survey.notes)
    for words in ("1 retaining wall", "2 breaklines of type proximity", "without edgeTrim"):
        assert words in told


def test_contours_are_soft_breaklines_at_their_elevation(write):
    contours = """<Contours><Contour elev="5.5"><PntList2D>0 0 0 4 4 4</PntList2D></Contour>
<Contour elev="6"><PntList2D>9 0 9 4</PntList2D></Contour></Contours>"""
    survey = ts.read(write(only_source(contours)))
    assert [line.kind for line in survey.breaklines] == ["soft", "soft"]
    assert survey.breaklines[0].coords.tolist() == [[0, 0, 5.5], [4, 0, 5.5], [4, 4, 5.5]]
    assert ts.triangulate(survey).points[:, 2].max() == 6
    refused("elevation 'x'", write(only_source(contours.replace('"6"', '"x"'))))


def test_chains_join_survey_points(write):
    path = write(only_source('<Chain name="edge">7 8 11</Chain>', POINTS))
    survey = ts.read(path)
    (line,) = survey.breaklines
    assert line.name == "edge"
    assert line.coords.tolist() == survey.points.tolist()
    assert "survey points of the file" in " ".join(survey.notes)
    refused("'99', which there is not", write(only_source("<Chain>7 99</Chain>", POINTS)))


def test_point_files_are_named_and_not_followed(write, tmp_path):
    (tmp_path / "b.txt").write_text("1,2,3\n")
    files = '<PointFiles><PointFile fileName="b.txt" fileType="t" fileFormat="f"/></PointFiles>'
    survey = ts.read(write(only_source(files + LINES)))
    assert len(survey) == 0
    assert "'b.txt'" in " ".join(survey.notes)
    assert "points are missing" in " ".join(survey.notes)


def test_source_data_with_points_of_their_own_beside_survey_points_are_a_choice(write):
    data = "<DataPoints><PntList3D>0 0 1 0 9 2 9 9 3 9 0 4</PntList3D></DataPoints>"
    path = write(only_source(data, POINTS))
    refused("`content='source'` or `content='points'`", path)
    assert len(ts.read(path, content="source")) == 4
    assert len(ts.read(path, content="points")) == 3


@pytest.mark.parametrize(
    ("inner", "words"),
    [
        ("<Breaklines><Breakline><PntList3D>0 0 1 2</PntList3D></Breakline></Breaklines>", "4 num"),
        ("<Breaklines><Breakline><PntList3D>0 0 x</PntList3D></Breakline></Breaklines>", "'x'"),
        ('<Boundaries><Boundary bndType="outer"><PntList2D>0 0 1 1</PntList2D></Boundary>'
         "</Boundaries>", "with k >= 3|two corners"),
        ("<DataPoints><PntList2D>0 0 1 1</PntList2D></DataPoints>", "no elevations"),
        ("<Breaklines><Breakline><PntList3D>0 0 1e999 1 1 1</PntList3D></Breakline></Breaklines>",
         "not finite"),
        ("", "neither"),
    ],
)  # fmt: skip
def test_faulty_source_data_are_refused(write, inner, words):
    refused(words, write(only_source(inner)))


def test_lines_of_a_surface_are_its_lines_where_they_run_along_edges(write):
    lines = """<Breaklines><Breakline name="ridge"><PntList3D>0 0 1 4 4 3</PntList3D></Breakline>
<Breakline><PntList3D>0 4 2 4 0 4</PntList3D></Breakline></Breaklines>
<Boundaries><Boundary bndType="outer" edgeTrim="true"><PntList2D>0 0 0 4 4 4 4 0</PntList2D>
</Boundary></Boundaries>"""
    tin = ts.read(write(document(surface(points_of(CORNERS), source=source(lines)))))
    assert tin.lines.kinds == ("hard", "boundary")
    assert tin.lines.names == ("ridge", "")
    assert [chain.tolist() for chain in tin.lines.chains()] == [[0, 2], [0, 1, 2, 3, 0]]
    assert int(tin.constrained.sum()) == 2 + 4
    assert "1 line of 3 does not run along edges" in " ".join(tin.report.notes)


def test_survey_points_are_read_in_time(write):
    rows = "".join(f'<CgPoint name="{k}">{k} {k} 1</CgPoint>' for k in range(20_000))
    survey = ts.read(write(document(points=f"<CgPoints>{rows}</CgPoints>", units=METRIC)))
    assert np.array_equal(survey.points[:, 0], np.arange(20_000))


def test_points_that_are_planned_or_gone_are_told(tmp_path):
    points = """<CgPoints><CgPoint name="1" state="existing">0 0 5</CgPoint>
<CgPoint name="2" state="proposed">0 9 6</CgPoint><CgPoint name="3">9 9 7</CgPoint>
<CgPoint name="4" state="destroyed">9 0 8</CgPoint>
<CgPoint name="5" state="proposed">4 4 8</CgPoint></CgPoints>"""
    path = tmp_path / "a.xml"
    path.write_text(document("", points=points))
    survey = ts.read(path)
    assert survey.attributes["state"].tolist() == [
        "existing", "proposed", "", "destroyed", "proposed",
    ]  # fmt: skip
    assert survey.notes[-1] == (
        "Of 5 survey points 2 proposed and 1 destroyed, by their state, are read as the others "
        "are: the attribute state tells them apart."
    )
    path.write_text(document("", points=points.replace("proposed", "existing").replace(
        'state="destroyed"', "")))  # fmt: skip
    assert not any("by their state" in note for note in ts.read(path).notes)


def test_plan_features_and_alignments_are_told(tmp_path):
    line = "<CoordGeom><Line><Start>0 0 1</Start><End>5 5 2</End></Line></CoordGeom>"
    planned = f"""<PlanFeatures><PlanFeature name="kerb">{line}</PlanFeature>
<PlanFeature name="wall">{line}</PlanFeature></PlanFeatures>
<Alignments><Alignment name="road" length="7" staStart="0">{line}</Alignment></Alignments>"""
    path = tmp_path / "a.xml"
    path.write_text(document("", points=POINTS + planned))
    assert "Not read: 2 plan features, 1 alignment." in ts.read(path).notes


def boundary(kind):
    named = "" if kind is None else f' bndType="{kind}"'
    return (
        f'<Boundaries><Boundary{named} edgeTrim="false"><PntList3D>1 1 1 1 4 1 4 4 1 1 1 1'
        "</PntList3D></Boundary></Boundaries>"
    )


POINTS_OF_SOURCE = "<DataPoints><PntList3D>0 0 1 0 9 2 9 9 3 9 0 4 5 5 6</PntList3D></DataPoints>"


@pytest.mark.parametrize("kind", ["texture", "", None, "Retain", "\u00e4"])
def test_boundaries_of_other_things_are_left_out(write, kind):
    survey = ts.read(write(only_source(POINTS_OF_SOURCE + boundary(kind))), content="source")
    assert len(survey.points) == 5
    assert survey.boundary == survey.holes == []
    (note,) = [note for note in survey.notes if "bndType" in note]
    assert note.startswith(f"1 boundary left out, whose bndType ('{kind or ''}')")
    assert not any("edgeTrim" in note for note in survey.notes)


@pytest.mark.parametrize("kind", ["Outer", " outer ", "OUTER"])
def test_types_of_boundaries_are_read_in_any_letters(write, kind):
    survey = ts.read(write(only_source(POINTS_OF_SOURCE + boundary(kind))))
    assert len(survey.boundary) == 1
