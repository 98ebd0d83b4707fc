"""Files of instruments: fields where the manuals have them, units, stations, codes, and faults.

The lines follow the examples of the manuals that the readers name: TPS1100 User Manual 2.2, chapter
Data format; Nikon N Series Instruction Manual, SDR2x and SDR33 record formats; JobXML schema 5.3.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.refusals import refuse

import tinsmith as ts
from tinsmith.io.field_survey.formats import is_dc, is_gsi, is_jobxml, is_sdr
from tinsmith.io.field_survey.instruments.reduction import (
    Shot,
    Station,
    reduce_shot,
    to_radians,
)


def read(tmp_path, name, text, **options):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return ts.read(path, **options)


def refused(words, tmp_path, name, text, error=ts.ReadError, **options):
    refuse(words, read, tmp_path, name, text, error=error, **options)


# ------------------------------------------------------------------ GSI

GSI8 = """\
110001+00000001 21.322+03496940 22.322+09364360 31..00+00030485 51..1.+0000+000 \
87..10+00001500 81..00+00515836 82..00+00525871 83..00+00003079 71....+000000EP 32..10+00030333 \r
110002+00000H66 21.322+02179330 22.322+09442590 31..00+00030596 51..1.+0000+000 \
87..10+00001500 81..00+00510231 82..00-00528710 83..00-00002716 71....+00000000 \r
"""


def gsi16(number, *words):
    return f"*{number} " + " ".join(words) + " \r\n"


def word(index, info, value, digits=16):
    sign = "-" if str(value).startswith("-") else "+"
    return f"{index}{info}{sign}{str(value).lstrip('-').rjust(digits, '0')}"


def test_gsi_8(tmp_path):
    survey = read(tmp_path, "a.gsi", GSI8)
    assert survey.points.tolist() == [[515.836, 525.871, 3.079], [510.231, -528.71, -2.716]]
    assert survey.attributes["number"].tolist() == ["1", "H66"]
    assert survey.attributes["description"].tolist() == ["EP", ""]
    assert survey.elevation_unit == ts.Unit.of("m")


@pytest.mark.parametrize(("unit", "value"), [("0", 123_456), ("6", 1_234_560), ("8", 12_345_600)])
def test_gsi_16_and_the_digits_of_metres(tmp_path, unit, value):
    line = gsi16(
        word("11", "0001", "PNC0055"),
        *(word(f"{index}", f"..0{unit}", value) for index in (81, 82)),
        word("83", f"..0{unit}", -value),
    )
    survey = read(tmp_path, "a.txt", line)
    assert survey.points.tolist() == [[123.456, 123.456, -123.456]]
    assert survey.attributes["number"].tolist() == ["PNC0055"]


def test_gsi_blocks_in_one_line(tmp_path):
    blocks = [
        f"11000{i}+0000000{i} 81..00+0000{i}000 82..00+00002000 83..00+00003000" for i in (1, 2, 3)
    ]
    survey = read(tmp_path, "a.gsi", " ".join(blocks) + "\n")
    assert survey.points[:, 0].tolist() == [1.0, 2.0, 3.0]
    assert survey.attributes["number"].tolist() == [1, 2, 3]


@pytest.mark.parametrize("data", ["00000000000-----", "----------------", "            ----"])
def test_gsi_dashes_are_no_value(tmp_path, data):
    """Leica writes them where a value could not be computed."""
    whole = "*110001+0000000000000001 81..10+0000000000001000 82..10+0000000000002000 "
    text = f"{whole}83..10+0000000000003000 \n{whole.replace('1 81', '2 81')}83..10+{data} \n"
    survey = read(tmp_path, "a.gsi", text)
    assert survey.points.tolist() == [[1.0, 2.0, 3.0]]
    assert survey.skipped_lines == {"points without elevation": (2,)}


COORDINATES = "81..00+00001000 82..00+00002000 83..00+00003000"
CODE = "410001+00000013 42....+000TREES 43....+000004.5"


def test_gsi_codes_before_or_after_their_points(tmp_path):
    points = [f"11000{i}+0000000{i} {COORDINATES}" for i in (1, 2)]
    before = "\n".join([CODE, points[0], points[1]])
    after = "\n".join([points[0], points[1], CODE])
    both = "\n".join([CODE, points[0], points[1], CODE])
    told = "13 TREES 4.5"
    assert read(tmp_path, "a.gsi", before).attributes["description"].tolist() == [told, ""]
    assert read(tmp_path, "a.gsi", after).attributes["description"].tolist() == ["", told]
    doubtful = read(tmp_path, "a.gsi", both)
    assert "description" not in doubtful.attributes
    assert "2 blocks of codes are not read" in doubtful.notes[0]
    between = read(tmp_path, "a.gsi", "\n".join([points[0], CODE, points[1]]))
    assert "1 block of codes is not read" in between.notes[0]
    found = read(tmp_path, "a.gsi", both, code_blocks="after")
    assert found.attributes["description"].tolist() == ["", told]
    refused(
        "Invalid code_blocks 'near': it must be one of before, after",
        tmp_path,
        "a.gsi",
        both,
        ts.OptionError,
        code_blocks="near",
    )


STATION = gsi16(
    word("11", "0001", "ST01"),
    word("84", "..10", 500_000),
    word("85", "..10", 600_000),
    word("86", "..10", 100_000),
    word("88", "..10", 1_324),
)


def shot(name, circle, zenith, distance, unit="4", height=1_300):
    return gsi16(
        word("11", "0002", name), word("21", f".02{unit}", circle),
        word("22", f".02{unit}", zenith), word("31", "...0", distance),
        word("87", "...0", height),
    )  # fmt: skip


def test_gsi_shots_are_reduced_where_the_circle_is_oriented(tmp_path):
    # 35° 45' 10.0" and 91° 17' 51.0", as DDD.MMSSs
    text = STATION + shot("GDEM5415", 3_545_100, 9_117_510, 13_825)
    refused("no point with coordinates: 1 shot without orient.*oriented", tmp_path, "a.gsi", text)
    survey = read(tmp_path, "a.gsi", text, oriented=True)
    hz, v = math.radians(35 + 45 / 60 + 10 / 3600), math.radians(91 + 17 / 60 + 51 / 3600)
    expected = [
        500 + 13.825 * math.sin(v) * math.sin(hz),
        600 + 13.825 * math.sin(v) * math.cos(hz),
        100 + 1.324 + 13.825 * math.cos(v) - 1.3,
    ]
    assert np.allclose(survey.points, [expected], rtol=0, atol=1e-9)
    assert "1 point is reduced from angles and distances, with no scale" in survey.notes[0]


@pytest.mark.parametrize(
    ("unit", "circle", "zenith"),
    [("2", 10_000_000, 10_000_000), ("3", 9_000_000, 9_000_000), ("5", 16_000_000, 16_000_000)],
)
def test_gsi_units_of_angles(tmp_path, unit, circle, zenith):
    survey = read(
        tmp_path, "a.gsi", STATION + shot("1", circle, zenith, 10_000, unit), oriented=True
    )
    assert np.allclose(survey.points, [[510.0, 600.0, 100.024]], rtol=0, atol=1e-9)


def test_gsi_shots_with_coordinates_prove_the_orientation(tmp_path):
    known = (
        shot("1", 10_000_000, 10_000_000, 10_000, "2").rstrip()
        + " "
        + " ".join(
            [word("81", "..00", 510_000), word("82", "..00", 600_000), word("83", "..00", 100_024)]
        )
    )
    other = shot("2", 20_000_000, 10_000_000, 10_000, "2")
    survey = read(tmp_path, "a.gsi", STATION + known + "\r\n" + other)
    assert np.allclose(survey.points[1], [500.0, 590.0, 100.024], rtol=0, atol=1e-9)
    turned = known.replace("+0000000000510000", "+0000000000511000")
    survey = read(tmp_path, "a.gsi", STATION + turned + "\r\n" + other)
    assert len(survey) == 1
    assert survey.skipped == {"shots without orientation": 1}


def test_gsi_feet(tmp_path):
    text = "110001+00000001 81..01+00515836 82..01+00525871 83..01+00003079\n"
    refused("in feet and does not say which: give `elevation_unit='ft'`", tmp_path, "a.gsi", text)
    assert read(tmp_path, "a.gsi", text, elevation_unit="ft").elevation_unit == ts.Unit.of("ft")
    survey = read(tmp_path, "a.gsi", text, crs="EPSG:2274")
    assert survey.points[0].tolist() == [515.836, 525.871, 3.079]
    assert survey.elevation_unit == ts.Unit.of("US survey foot")
    assert "feet, taken to be the US survey foot of EPSG:2274" in " ".join(survey.notes)
    refused("must be foot", tmp_path, "a.gsi", text, ts.OptionError, elevation_unit="m")
    both = text + "110002+00000002 81..00+00515836 82..00+00525871 83..00+00003079\n"
    refused("metres .line 2. and in feet .line 1.", tmp_path, "a.gsi", both)


def test_metres_are_converted_to_the_feet_of_the_crs(tmp_path):
    survey = read(tmp_path, "a.gsi", GSI8, crs="EPSG:2274")
    assert np.allclose(survey.points[0, :2] * 1200 / 3937, [515.836, 525.871])
    assert survey.points[0, 2] == 3.079
    assert survey.elevation_unit == ts.Unit.of("m")
    assert "converted from metre, the unit of the file, to US survey foot" in survey.notes[0]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("110001+00000001 81..00+0051583 82..00+00525871\n", "line 1: '81..00.* no word of GSI"),
        ("110001+00000001 81..05+00515836 82..00+00525871\n", "word 81 is '5.*unit digit 0, 1"),
        ("110001+00000001 81..00+0051583X 82..00+00525871\n", "word 81 is .*digits alone"),
        ("110001+0000001 81..00+00515836\n", "8 characters behind its sign, or 16"),
        ("410001+00000013\n", "no block of a point"),
        ("110001+00000001 21.024+03575000 22.024+09000000 31..00+00001000\n", "below 60"),
        ("110001+00000001 81..00+00515836 82..00+0052", "line 1: '82..00.* no word"),
    ],
)
def test_faults_of_gsi(tmp_path, text, words):
    refused(words, tmp_path, "a.gsi", text)


# ------------------------------------------------------------------ SDR


def sdr33(kind, *cells):
    return kind + "".join(f"{cell:<16}" for cell in cells) + "\n"


def sdr20(kind, names, numbers, text=""):
    return (
        kind
        + "".join(f"{one:>4}" for one in names)
        + "".join(f"{one:<10}" for one in numbers)
        + f"{text:<16}\n"
    )


def header(version="SDR33 V04-04.02", units="211111"):
    return f"00NM{version:<16}    {'05-Nov-20 08:00':<16}{units}\n"


def test_sdr33_coordinates(tmp_path):
    text = header() + sdr33("02TP", "31", "509.97", "937.274", "20.053", "1.505", "11")
    text += "13PCP.C. mm Applied:-30.000\n" + sdr33(
        "08TP", "9", "510.504", "908.838", "19.699", "EP1"
    )
    text += sdr33("08KI", "10", "510.4", "907.757", "", "EP1 E")
    survey = read(tmp_path, "a.sdr", text)
    assert survey.points.tolist() == [[908.838, 510.504, 19.699]]
    assert survey.attributes["description"].tolist() == ["EP1"]
    assert survey.skipped_lines == {"points without elevation": (5,)}
    east_first = read(tmp_path, "a.sdr", text.replace("211111", "211121"))
    assert east_first.points.tolist() == [[510.504, 908.838, 19.699]]


@pytest.mark.parametrize("start", ["\x02\n", "\x02\r\n", "\x02", "\n\x02\n"])
def test_sdr_after_the_mark_of_a_download(tmp_path, start):
    rows = [header(), sdr33("08TP", "1", "5.000", "7.000", "3.000", "a")]
    plain = read(tmp_path, "a.sdr", "\n".join(rows) + "\n")
    marked = read(tmp_path, "b.txt", start + "\n".join(rows) + "\n\x03\n")
    assert marked.points.tolist() == plain.points.tolist() == [[7.0, 5.0, 3.0]]


def test_sdr20_has_narrow_columns(tmp_path):
    text = header("SDR20V03-05", "111111")
    text += sdr20("08KI", ["  12"], ["4024238.12", "752646.125", "320.565"], "GS")
    survey = read(tmp_path, "a.sdr", text)
    assert survey.points.tolist() == [[752646.125, 4024238.12, 320.565]]
    assert survey.attributes["number"].tolist() == [12]


def test_sdr_observations_are_reduced(tmp_path):
    """The instrument's own coordinates of such shots were 19.914, 9.217, 0.975 and the others."""
    text = header(units="213111") + sdr33("06NM", "1.00000000")
    text += sdr33("02TP", "STZ", "0.000", "0.000", "0.000", "1.475", "")
    text += sdr33("07TP", "STZ", "OR", "0.0000", "0.0000") + sdr33("03NM", "0.000")
    text += sdr33("09F1", "STZ", "1", "21.949", "101.4508", "27.5962", "KERB")
    text += sdr33("09F1", "STZ", "3", "22.225", "99.4740", "64.1306", "CP12") + sdr33(
        "03NM", "1.530"
    )
    text += sdr33("09F1", "STZ", "6", "13.878", "102.9952", "314.8086", "NAIL")
    survey = read(tmp_path, "a.sdr", text)
    expected = [[9.217, 19.914, 0.975], [18.789, 11.870, 1.659], [-13.489, 3.196, -0.708]]
    assert np.allclose(survey.points, expected, rtol=0, atol=0.0006)
    assert survey.attributes["description"].tolist() == ["KERB", "CP12", "NAIL"]
    turned = text.replace(
        sdr33("07TP", "STZ", "OR", "0.0000", "0.0000"),
        sdr33("07TP", "STZ", "OR", "150.0000", "50.0000"),
    )
    e, n, z = np.array(expected).T
    found = read(tmp_path, "a.sdr", turned).points
    assert np.allclose(found, np.column_stack([n, -e, z]), rtol=0, atol=0.0006)
    curved = read(tmp_path, "a.sdr", text, refraction=0.13).points
    across = np.hypot(*survey.points[:, :2].T)
    lift = 0.87 * across**2 / (2 * 6_371_000)
    assert np.allclose(curved[:, 2] - survey.points[:, 2], lift, rtol=1e-3, atol=1e-12)


def test_sdr_both_faces_are_the_same_shot(tmp_path):
    text = header(units="211111") + sdr33("02KI", "S", "0", "0", "0", "0", "")
    text += sdr33("07KI", "S", "B", "0", "0") + sdr33("03NM", "0")
    face1 = text + sdr33("09F1", "S", "1", "100", "95", "30", "")
    face2 = text + sdr33("09F2", "S", "1", "100", "305", "230", "")
    one, two = (read(tmp_path, "a.sdr", each).points for each in (face1, face2))
    assert np.allclose(one, two, rtol=0, atol=1e-9)


def test_sdr_shots_that_cannot_be_reduced_are_left_out(tmp_path):
    station = sdr33("02KI", "S", "0", "0", "0", "1.5", "")
    bearing = sdr33("07KI", "S", "B", "0", "0")
    known = sdr33("08TP", "9", "1", "2", "3", "")
    good = sdr33("03NM", "1.5") + sdr33("09F1", "S", "1", "10", "100", "0", "")
    whole = header() + station + bearing + known
    assert len(read(tmp_path, "a.sdr", whole + good)) == 2
    for text in (
        header() + bearing + known + good,  # no station
        header() + station + known + good,  # no bearing
        header() + station.replace("1.5 ", "    ") + bearing + known + good,
        whole + sdr33("09F1", "S", "1", "10", "100", "0", ""),  # no height of the target
        whole + good.replace("09F1", "09MC"),  # corrected by the instrument, who knows how
        header() + sdr33("06NM", "0.9996") + station + bearing + known + good,
        whole + good.replace("100 ", "    "),
    ):
        survey = read(tmp_path, "a.sdr", text)
        assert len(survey) == 1, text
        assert sum(survey.skipped.values()) == 1
        assert "left out" in " ".join(survey.notes)


def test_a_last_record_that_may_be_cut_is_left_out(tmp_path):
    text = header() + sdr33("08TP", "9", "1", "2", "3") + sdr33("08TP", "10", "1", "2", "320.565")
    assert len(read(tmp_path, "a.sdr", text.rstrip("\n"))) == 2
    for length in range(3, 14):
        survey = read(tmp_path, "a.sdr", text[:-length].rstrip(" "))
        assert survey.skipped_lines == {"records without an end that may be cut": (3,)}
        assert survey.points.tolist() == [[2, 1, 3]]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("00NMSDR99\n", "and an SDR file with the record 00 of SDR33"),
        (header(units="911111"), "units of the header are '911111'"),
        (header(units=""), "units of the header are ''"),
        (header() + sdr33("08TP", "9", "51O.5", "908.8", "19.7"), "line 2: '51O.5' stands where"),
        (header() + sdr33("08TP", "9", "1e999", "908.8", "19.7"), "'1e999' is no finite number"),
        (header(), "holds no point with coordinates"),
    ],
)
def test_faults_of_sdr(tmp_path, text, words):
    refused(words, tmp_path, "a.sdr", text, format="sdr")


# ------------------------------------------------------------------ Trimble DC


def dc_header(units="111111"):
    return f"00NM{'SC V10-70':<16}1021{'05-Jan-26 12:20':<16}{units}\r\n10NM{'SITE':<16}121111\r\n"


def gnss(name):
    """A position as a real job has it, its fields without a blank between them."""
    return f"66KI{name:>16}-45.784424760500-68.239471013000705.67700000000050              11\r\n"


def test_dc_grid_positions(tmp_path):
    text = dc_header() + "65KI6378137.00000000298.257223563000\r\n13TSTime Date 02/05/2026\r\n"
    text += (
        "69KI            PF104024238.12000000752646.125000000320.565000000000EP1 ST          11\r\n"
    )
    text += (
        "69TP            PF114024239.12000000752647.125000000-20.565000000000EP1             14\r\n"
    )
    survey = read(tmp_path, "a.dc", text, crs="EPSG:32616")
    assert survey.points.tolist() == [
        [752646.125, 4024238.12, 320.565],
        [752647.125, 4024239.12, -20.565],
    ]
    assert survey.attributes["number"].tolist() == ["PF10", "PF11"]
    assert survey.attributes["description"].tolist() == ["EP1 ST", "EP1"]
    assert survey.attributes["method"].tolist() == ["11", "14"]
    assert "classifications 1, 4: all are read" in " ".join(survey.notes)
    east_first = read(tmp_path, "a.dc", text.replace("111111\r\n10NM", "111121\r\n10NM"))
    assert east_first.points[0].tolist() == [4024238.12, 752646.125, 320.565]


@pytest.mark.parametrize("length", ["2", "3"])
def test_dc_feet_are_of_whoever_says_which(tmp_path, length):
    text = dc_header(f"1{length}1111") + sdr33("69KI", "1", "200", "100", "50")
    refused("is in feet and does not say which", tmp_path, "a.dc", text)
    survey = read(tmp_path, "a.dc", text, crs="EPSG:2264")
    assert survey.points.tolist() == [[100, 200, 50]]
    assert survey.elevation_unit == ts.Unit.of("US survey foot")
    assert read(tmp_path, "a.dc", text, elevation_unit="ft").elevation_unit == ts.Unit.of("ft")


def test_dc_positions_and_observations_are_left_out_and_told(tmp_path):
    text = dc_header() + sdr33("08KI", "A", "1", "2", "3", "GS") + gnss("A") + gnss("B")
    text += sdr33("79TP", "A", "12", "90.5", "100.25", "20.5") + sdr33("69KI", "C", "1", "2", "")
    survey = read(tmp_path, "a.dc", text)
    assert survey.points.tolist() == [[2, 1, 3]]
    assert survey.skipped == {
        "points without elevation": 1,
        "positions (66) of GNSS without grid coordinates": 1,
        "observations (79), which are not reduced,": 1,
    }
    said = " ".join(survey.notes)
    assert "1 position (66) of GNSS without grid coordinates is left out: line 5." in said
    assert "1 observation (79), which are not reduced, is left out: line 6." in said


def test_a_dc_file_of_gnss_positions_alone_is_refused(tmp_path):
    refused(
        r"holds no point with coordinates: 2 positions \(66\) .*export the job with grid",
        tmp_path, "a.dc", dc_header() + gnss("A") + gnss("B"),
    )  # fmt: skip


def test_a_last_dc_record_that_may_be_cut_is_left_out(tmp_path):
    whole = dc_header() + sdr33("69KI", "9", "1", "2", "3")
    text = whole + sdr33("69KI", "10", "1", "2", "320.565000000000").rstrip("\n")
    assert len(read(tmp_path, "a.dc", text)) == 2
    for length in range(1, 14):
        survey = read(tmp_path, "a.dc", text[:-length])
        assert survey.skipped == {"records without an end that may be cut": 1}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("10NMSITE\n", "begins with '10NMSITE', and a Trimble DC file with the record 00"),
        (dc_header(units="191111"), "units of the header are '191111'"),
        ("00NMSC V10-70 (synthetic)\n", "units of the header are ''"),
        (dc_header() + sdr33("69KI", "9", "51O.5", "9", "1"), "line 3: '51O.5' stands where"),
        (dc_header() + sdr33("69KI", "9", "1e999", "9", "1"), "line 3: '1e999' stands where"),
        (dc_header(), "holds no point with coordinates"),
    ],
)
def test_faults_of_dc(tmp_path, text, words):
    refused(words, tmp_path, "a.dc", text, format="dc")


# ------------------------------------------------------------------ JobXML


def point(tag, name, *, code="", grid=None, computed=None, deleted="false", method="KeyedIn"):
    def place(kind, values):
        if values is None:
            return ""
        n, e, z = values
        return f"<{kind}><North>{n}</North><East>{e}</East><Elevation>{z}</Elevation></{kind}>"

    return (
        f"<{tag}><Name>{name}</Name><Code>{code}</Code><Method>{method}</Method>"
        f"<Deleted>{deleted}</Deleted>{place('Grid', grid)}"
        f"{place('ComputedGrid', computed)}</{tag}>\n"
    )


def job(field="", reductions="", more=""):
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<JOBFile jobName="S" version="5.72">\n'
        f"<FieldBook>{field}</FieldBook>\n<Reductions>{reductions}</Reductions>{more}</JOBFile>\n"
    )


def test_jobxml_reductions_are_read_before_the_field_book(tmp_path):
    field = point("PointRecord", "1", grid=(10, 20, 5), code="EP1 ST")
    field += point(
        "PointRecord", "2", computed=(11, 21, 6), code="EP1 &amp; FL1", method="DirectReading"
    )
    field += point("PointRecord", "3", grid=(0, 0, 0), deleted="true") + point("PointRecord", "4")
    survey = read(tmp_path, "a.jxl", job(field))
    assert survey.points.tolist() == [[20, 10, 5], [21, 11, 6]]
    assert survey.attributes["description"].tolist() == ["EP1 ST", "EP1 & FL1"]
    assert survey.attributes["method"].tolist() == ["KeyedIn", "DirectReading"]
    assert survey.skipped == {
        "points deleted in the field": 1,
        "points without a position in the grid": 1,
    }
    reduced = read(tmp_path, "a.jxl", job(field, point("Point", "1", grid=(10.5, 20.5, 5.5))))
    assert reduced.points.tolist() == [[20.5, 10.5, 5.5]]
    assert "2 points of the field book are not in the reductions, and not read: 2, 4" in str(
        reduced.notes
    )
    both = point("Point", "1", grid=(10.5, 20.5, 5.5)) + point("Point", "2", grid=(11, 21, 6))
    (note,) = read(tmp_path, "a.jxl", job(field, both)).notes
    assert note.startswith("1 point of the field book is not in the reductions, and not read: 4")


def test_jobxml_is_in_metres_whatever_it_shows(tmp_path):
    units = "<UnitsRecord><DistanceUnits>USSurveyFeet</DistanceUnits></UnitsRecord>"
    text = job(units + point("PointRecord", "1", grid=(100, 200, 5)))
    survey = read(tmp_path, "a.jxl", text, crs="EPSG:2274")
    assert np.allclose(survey.points, [[200 * 3937 / 1200, 100 * 3937 / 1200, 5]])
    assert survey.elevation_unit == ts.Unit.of("m")
    refused("must be metre", tmp_path, "a.jxl", text, ts.OptionError, elevation_unit="ft")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (job() + "<", "line 5: it is no well-formed XML"),
        (job(point("PointRecord", "1", grid=(1, "x", 3))), "line 3: 'x' stands where a coordin"),
        (job(point("PointRecord", "1", grid=(1, "inf", 3))), "'inf' stands where a coordinate"),
        (job(point("PointRecord", "1")), "no point with coordinates: 1 point without a position"),
        (job("<a>" * 70 + "</a>" * 70), "nested deeper than 64"),
        (job(more="<GridOrientation>IncreasingSouthWest</GridOrientation>"), "IncreasingSouthWest"),
        ('<!DOCTYPE JOBFile [<!ENTITY a "b">]>' + job()[39:], "declares a document type"),
        ('<!DOCTYPE JOBFile SYSTEM "http://127.0.0.1:9/a.dtd">' + job()[39:], "document type"),
    ],
)
def test_faults_of_jobxml(tmp_path, text, words):
    refused(words, tmp_path, "a.jxl", text)


def test_an_encoding_that_is_not_known(tmp_path):
    text = job().replace("UTF-8", "EBCDIC-9")
    refused("a.jxl", tmp_path, "a.jxl", text)


# ------------------------------------------------------------------ all


def test_the_content_shows_the_format_whatever_the_suffix(tmp_path):
    assert is_gsi(GSI8.encode())
    assert is_gsi(b"*110001+0000000000000001 81..00+0000000000001000 ")
    assert not is_gsi(b"11,12,13\n")
    assert not is_gsi(b"110001.5 12 13\n")
    assert is_sdr(header().encode())
    assert not is_sdr(b"00NM is a name\n")
    assert is_jobxml(job().encode())
    assert not is_jobxml(b"<LandXML>")
    assert len(read(tmp_path, "a.txt", GSI8)) == 2
    assert len(read(tmp_path, "b.csv", header() + sdr33("08TP", "9", "1", "2", "3"))) == 1
    assert len(read(tmp_path, "c.xml", job(point("PointRecord", "1", grid=(1, 2, 3))))) == 1
    assert is_dc(dc_header().encode())
    assert not is_dc(header().encode())
    assert len(read(tmp_path, "d.txt", dc_header() + sdr33("69KI", "9", "1", "2", "3"))) == 1
    for name in ("gsi", "sdr", "jobxml", "dc"):
        assert ts.find_format(name).write is None


def test_lines_run_in_the_order_of_the_file(tmp_path):
    rows = "".join(
        sdr33("08TP", name, n, 2, 3, "EP1") for name, n in (("A9", 1), ("A10", 2), ("A11", 3))
    )
    made = ts.lines_from_codes(read(tmp_path, "a.sdr", header() + rows))
    assert made.breaklines[0].coords[:, 1].tolist() == [1, 2, 3]


@pytest.mark.parametrize("value", ["x", math.nan, 9])
def test_a_coefficient_of_refraction(tmp_path, value):
    refused(
        "Invalid refraction .* a coefficient from -5 to 5",
        tmp_path, "a.gsi", GSI8, ts.OptionError, refraction=value,
    )  # fmt: skip


def test_a_shot_reduced_by_vectors():
    """A second opinion by complex numbers, on both faces."""
    rng = np.random.default_rng(7)
    for _ in range(200):
        circle, turn = rng.uniform(0, 2 * math.pi, 2)
        zenith, s, i, t = rng.uniform([0.3, 1, 1, 0], [2.8, 900, 2, 3])
        station = Station(*rng.uniform(0, 1e6, 3), i, turn)
        ray = 1j * np.exp(-1j * (circle + turn))  # north, turned clockwise
        across = s * math.sin(zenith) * ray
        expected = np.add(station[:3], [across.real, across.imag, s * math.cos(zenith)])
        expected[2] += i - t
        shot = Shot(circle, zenith, s, t)
        other = Shot(circle + math.pi, 2 * math.pi - zenith, s, t)
        for one in (shot, other):
            found = reduce_shot(station, one, refraction=None, metres=1.0)
            assert np.allclose(found, expected, rtol=0, atol=1e-6)


def test_sexagesimal_angles():
    assert to_radians(123.59599, "sexagesimal") == pytest.approx(
        math.radians(123 + 59 / 60 + 59.9 / 3600), abs=1e-12
    )
    assert math.isnan(to_radians(12.6, "sexagesimal"))
