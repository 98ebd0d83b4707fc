"""Small readers written from public specifications, of formats that no kept program reads here.

They share nothing with the product, take only what our files have, and fail at anything else.
"""

from __future__ import annotations

import re
from math import hypot
from xml.etree import ElementTree as ET

import numpy as np

_LANDXML = "{http://www.landxml.org/schema/LandXML-1.2}"


def parse_adcirc(text):
    """Read nodes, elements and boundaries of a fort.14 or hgrid.gr3 with remarks, word by word."""
    rows = [line.split() for line in text.splitlines()]
    n_elements, n_nodes = map(int, rows[1])
    nodes = np.array(rows[2 : 2 + n_nodes], float)
    elements = np.array(rows[2 + n_nodes : 2 + n_nodes + n_elements], int)
    at = 2 + n_nodes + n_elements
    parts = []
    for _ in range(2):
        count, total, at = int(rows[at][0]), int(rows[at + 1][0]), at + 2
        part = []
        for _ in range(count):
            length, kind = map(int, rows[at][:2])
            part.append((kind, [int(row[0]) for row in rows[at + 1 : at + 1 + length]]))
            at += 1 + length
        assert sum(len(one) for _, one in part) == total
        parts.append(part)
    assert at == len(rows)
    return nodes, elements, parts


def parse_12da(text):
    """Return points and triangles from 0 of a tin, and strings with their names."""
    blocks = dict(re.findall(r"(points|triangles) \{\n([^}]*)\}", text))
    points = np.array(blocks["points"].split(), float).reshape(-1, 3)
    triangles = np.array(blocks["triangles"].split(), int).reshape(-1, 3) - 1
    strings = re.findall(r'string super \{\n  name "([^"]*)"\n.*?data_3d \{\n([^}]*)\}', text, re.S)
    return points, triangles, strings


def parse_landxml(path):
    """Return the points (northing, easting, elevation), faces and all coordinates of a LandXML."""
    root = ET.parse(path).getroot()
    assert root.tag == f"{_LANDXML}LandXML"
    assert len(root.findall(f"{_LANDXML}Units")) == 1
    numbers = {one.get("id"): k for k, one in enumerate(root.iter(f"{_LANDXML}P"))}
    points = [list(map(float, one.text.split())) for one in root.iter(f"{_LANDXML}P")]
    faces = [[numbers[key] for key in one.text.split()] for one in root.iter(f"{_LANDXML}F")]
    texts = [
        one.text
        for name in ("CgPoint", "PntList2D", "PntList3D", "Start", "End", "P")
        for one in root.iter(f"{_LANDXML}{name}")
        if one.text
    ]
    return np.array(points), np.array(faces), texts


def measure_landxml_alignment(path):
    """Return the length of the lines and circular arcs of an alignment, and that which it states.

    An arc is that of its centre from start to end, on the side that ``rot`` says.
    """
    (alignment,) = ET.parse(path).getroot().iter(f"{_LANDXML}Alignment")
    (geometry,) = alignment.findall(f"{_LANDXML}CoordGeom")
    total = 0.0
    for one in geometry:
        place = {
            part.tag.removeprefix(_LANDXML): [float(word) for word in part.text.split()[1::-1]]
            for part in one
            if part.text and part.text.strip()
        }
        start, end = place["Start"], place["End"]
        if one.tag == f"{_LANDXML}Line":
            total += hypot(end[0] - start[0], end[1] - start[1])
            continue
        assert one.tag == f"{_LANDXML}Curve", one.tag
        (x, y), turn = place["Center"], -1.0 if one.get("rot") == "cw" else 1.0
        first, last = (np.arctan2(b - y, a - x) for a, b in (start, end))
        total += hypot(start[0] - x, start[1] - y) * ((turn * (last - first)) % (2.0 * np.pi))
    return total, float(alignment.get("length"))
