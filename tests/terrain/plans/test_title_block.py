"""Title blocks of an office: what a template says stands on every sheet, and nothing is guessed."""

import datetime as dt
import re
import subprocess

import ezdxf
import numpy as np
import pytest
from PIL import Image
from support.printed import read_svg

import tinsmith as ts

EAST, NORTH = 500_000.0, 4_000_000.0
SQUARE = [
    [EAST, NORTH, 5],
    [EAST + 40, NORTH, 6],
    [EAST + 40, NORTH + 30, 7],
    [EAST, NORTH + 30, 9],
]
BLOCK = {
    "company": "Holm Surveying",
    "client": "City of Eastmoor",
    "project": "Dam road",
    "drawing_number": "HS-014-02",
    "drawn_by": "A. Berg",
    "checked_by": "C. Dale",
    "date": dt.date(2026, 11, 27),
    "rows": {"Job": 2026014, "Control": "May 2026"},
    "revisions": [
        {"mark": "A", "date": "2026-11-20", "text": "First issue", "by": "AB"},
        {"mark": "B", "date": dt.date(2026, 11, 27), "text": "Ditch added"},
    ],
}
SAID = {
    "Holm Surveying", "City of Eastmoor", "Dam road", "HS-014-02", "A. Berg", "C. Dale",
    "2026-11-27", "Job", "2026014", "Control", "May 2026", "A", "2026-11-20", "First issue", "AB",
    "B", "Ditch added",
}  # fmt: skip
TOML = """
company = "Holm Surveying"
client = "City of Eastmoor"
project = "Dam road"
drawing_number = "HS-014-02"
drawn_by = "A. Berg"
checked_by = "C. Dale"
date = 2026-11-27
[rows]
Job = 2026014
Control = "May 2026"
[[revisions]]
mark = "A"
date = "2026-11-20"
text = "First issue"
by = "AB"
[[revisions]]
mark = "B"
date = 2026-11-27
text = "Ditch added"
"""


@pytest.fixture(scope="module")
def tin():
    return ts.triangulate(SQUARE, crs="EPSG:32616", elevation_unit="m")


def draw(tin, what, **how):
    if what == "plan":
        return ts.plan(tin, **how)
    if what == "sections":
        line = [[EAST + 5, NORTH + 15], [EAST + 35, NORTH + 15]]
        return ts.section_sheets(tin, line, interval=10, width=10, **how)
    return ts.volume_report(tin, base=6.5, **how)


def read_lines(path):
    done = subprocess.run(
        ["pdftotext", "-layout", path, "-"], capture_output=True, text=True, check=True
    )
    return {part for line in done.stdout.splitlines() for part in re.split(r" {2,}", line.strip())}


@pytest.mark.parametrize("what", ["plan", "sections", "report"])
def test_every_drawing_says_what_the_template_says(tin, what, tmp_path):
    made = draw(tin, what, title_block=BLOCK)
    lines = read_lines(made.save(tmp_path / "a.pdf")[0])
    words = " ".join(lines)
    assert all(said in words for said in SAID), SAID - lines
    assert "WGS 84 / UTM zone 16N (EPSG:32616)" in words
    assert re.search(r"1:\d+", words)
    assert re.search(r"\b4 points", words)
    assert not any("cut" in note for note in made.notes)


def test_a_file_says_the_same_as_a_mapping(tin, tmp_path):
    file = tmp_path / "block.toml"
    file.write_text(TOML)
    one, other = (
        draw(tin, "plan", title_block=given).save(tmp_path / name)[0].read_bytes()
        for given, name in ((file, "a.svg"), (BLOCK, "b.svg"))
    )
    assert one == other


@pytest.mark.parametrize("paper", ["A4", "A1", (190, 400)])
def test_words_stay_in_the_block_and_the_map_above_it(tin, paper, tmp_path):
    plain, made = (draw(tin, "plan", paper=paper, title_block=one) for one in (None, BLOCK))
    page = read_svg(made.save(tmp_path / "a.svg")[0])
    before = read_svg(plain.save(tmp_path / "b.svg")[0])
    names = ("company", "field", "field-name", "revision")
    own = [text for text in page.texts if text.name in names]
    assert {text.text for text in own} >= SAID - {"2026-11-27"}
    top = page.frame[1]
    assert top > before.frame[1]
    assert all(8.0 < text.place[1] < top for text in own)
    facts = [text.place[1] for text in page.texts if text.name == "fact"]
    assert max(text.place[1] for text in own) < min(facts)
    assert {text.text for text in page.texts} - {text.text for text in own} >= {
        text.text for text in before.texts if text.name == "fact" and text.text.startswith("WGS")
    }


def test_a_given_date_goes_before_that_of_the_template(tin, tmp_path):
    made = draw(tin, "plan", title_block=BLOCK, date="2026-12-01")
    facts = {text.text for text in read_svg(made.save(tmp_path / "a.svg")[0]).named("fact")}
    assert "2026-12-01" in facts
    assert "2026-11-27" not in facts


def test_a_date_alone_takes_no_room(tin, tmp_path):
    alone = draw(tin, "plan", title_block={"date": "2026"}).save(tmp_path / "a.svg")[0]
    plain = draw(tin, "plan", date="2026").save(tmp_path / "b.svg")[0]
    assert alone.read_bytes() == plain.read_bytes()


def make_logo(folder, size=(60, 20), mode="RGB", color=(200, 30, 30)):
    Image.new(mode, size, color).save(folder / "logo.png")
    file = folder / "block.toml"
    file.write_text('company = "Holm"\nlogo = "logo.png"\n')
    return file


@pytest.mark.parametrize(("mode", "color"), [("RGB", (200, 30, 30)), ("L", 90), ("P", 3)])
def test_a_logo_is_drawn_in_its_shape(tin, mode, color, tmp_path):
    file = make_logo(tmp_path, mode=mode, color=color)
    (picture,) = draw(tin, "plan", title_block=file, grid="none").save(tmp_path / "a.png", dpi=100)
    cells = np.asarray(Image.open(picture).convert("RGB"), int)
    wanted = np.asarray(Image.open(tmp_path / "logo.png").convert("RGB"), int)[0, 0]
    is_logo = (np.abs(cells - wanted) <= 1).all(axis=2)
    is_logo &= is_logo.sum(axis=1, keepdims=True) > 30  # not the edges of letters
    rows, columns = np.nonzero(is_logo[:, : len(cells) // 3])
    assert np.ptp(columns) / np.ptp(rows) == pytest.approx(3.0, rel=0.1)
    assert len(rows) == pytest.approx(np.ptp(rows) * np.ptp(columns), rel=0.1)


def test_a_drawing_has_the_texts_and_says_that_it_has_no_logo(tin, tmp_path):
    made = draw(tin, "plan", title_block=make_logo(tmp_path))
    document = ezdxf.readfile(made.save(tmp_path / "a.dxf")[0])
    assert "Holm" in {one.dxf.text for one in document.modelspace().query("TEXT")}
    assert made.notes[-1] == "The logo is not drawn in DXF."
    made.save(tmp_path / "a.pdf")
    assert "The logo is not drawn in DXF." not in made.notes


@pytest.mark.parametrize(
    ("block", "sentence"),
    [
        ({"clinet": "x"}, "Invalid field in title_block 'clinet': it must be one of company,"),
        ({"client": "x" * 101}, "it must be at most 100 letters, and it has 101."),
        ({"client": 2.5}, "Invalid client in title_block 2.5: it must be text."),
        ({"client": True}, "Invalid client in title_block True: it must be text."),
        ({"client": ["a"]}, "it must be text."),
        ({"rows": ["a"]}, "it must be a table of at most 8 names with texts."),
        ({"rows": {str(k): "" for k in range(9)}}, "at most 8 names"),
        ({"rows": {"Job": 1.5}}, "Invalid row 'Job' in title_block 1.5: it must be text."),
        ({"revisions": {"mark": "A"}}, "a list of at most 10 tables with mark, date, text, by."),
        ({"revisions": [{}] * 11}, "a list of at most 10 tables"),
        ({"revisions": [{"name": "A"}]}, "Invalid field of a revision in title_block 'name'"),
        ({"revisions": [{"mark": 1.0}]}, "Invalid mark of a revision in title_block 1.0"),
        ({3: "x"}, "Invalid field in title_block 3"),
        (5, "title_block"),
    ],
)
def test_what_no_title_block_has_is_refused(tin, block, sentence):
    for what in ("plan", "sections", "report"):
        with pytest.raises(ts.OptionError, match=r"title.block") as raised:
            draw(tin, what, title_block=block)
        assert sentence in str(raised.value)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (b'client = "a', "Cannot read '.*block.toml' as TOML: "),
        (b"client = 'a'\nclient = 'b'", "as TOML: Cannot overwrite a value"),
        (b"\xff\xfe", "it is not UTF-8"),
        (b"a=" + b"[" * 5000, "as TOML"),
        (b"client = 1.5", "Invalid client in 'block.toml' 1.5"),
        (b"logo = 'none.png'", "Cannot read '.*none.png': No such file or directory."),
        (b"logo = 'block.toml'", "Cannot read '.*block.toml' as a logo: it is no PNG."),
    ],
)
def test_files_that_cannot_be_read_are_named(tin, text, sentence, tmp_path):
    file = tmp_path / "block.toml"
    file.write_bytes(text)
    with pytest.raises((ts.ReadError, ts.OptionError), match=sentence):
        draw(tin, "plan", title_block=file)


def test_a_missing_file_is_named(tin, tmp_path):
    with pytest.raises(ts.ReadError, match=r"none.toml': No such file or directory\."):
        draw(tin, "plan", title_block=tmp_path / "none.toml")
    with pytest.raises(ts.ReadError, match=r"Cannot read "):
        draw(tin, "plan", title_block=tmp_path)


def test_logos_that_are_broken_or_too_large_are_refused(tin, tmp_path):
    file = make_logo(tmp_path)
    data = (tmp_path / "logo.png").read_bytes()
    for broken, sentence in (
        (data[:40], "as a logo: "),
        (data[:16] + b"\x7f\xff\xff\xff" * 2 + data[24:], "at most 4,000,000 are drawn"),
        (b"", "it is no PNG"),
    ):
        (tmp_path / "logo.png").write_bytes(broken)
        with pytest.raises(ts.ReadError, match=sentence):
            draw(tin, "plan", title_block=file)


def test_texts_that_had_no_room_and_letters_that_the_font_lacks_are_told(tin, tmp_path):
    block = {"company": "W" * 100, "client": "\N{CJK UNIFIED IDEOGRAPH-56F3}"}
    made = draw(tin, "plan", title_block=block, paper="A4")
    made.save(tmp_path / "a.pdf")
    assert "The font has no '\N{CJK UNIFIED IDEOGRAPH-56F3}'" in made.notes[-2]
    assert made.notes[-1].startswith("Texts were cut")


def test_a_title_block_that_leaves_no_room_on_the_paper_is_refused(tin):
    block = BLOCK | {"rows": {str(k): "x" for k in range(8)}}
    for what in ("plan", "sections", "report"):
        with pytest.raises(ts.OptionError, match="title block leaves 12 mm of the height"):
            draw(tin, what, title_block=block, paper=(190, 190))
