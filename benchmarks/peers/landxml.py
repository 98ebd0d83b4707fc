"""LandXML by Python's own XML library: the numbers of a surface, and no checks."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from tinsmith.base.arrays import Float64Array, Int64Array
from tinsmith.tin import TIN

__all__ = ["read_with_etree", "write_with_etree"]

_SPACE = "http://www.landxml.org/schema/LandXML-1.2"


def read_with_etree(path: Path) -> tuple[Float64Array, Int64Array]:
    """Return points, easting first, and triangles by rows, of a file whose ids count from 1."""
    points: list[list[float]] = []
    faces: list[list[int]] = []
    for _, one in ET.iterparse(path):
        if one.tag == f"{{{_SPACE}}}P":
            points.append([float(word) for word in (one.text or "").split()])
        elif one.tag == f"{{{_SPACE}}}F":
            faces.append([int(word) for word in (one.text or "").split()])
        one.clear()
    return np.array(points)[:, [1, 0, 2]], np.array(faces) - 1


def write_with_etree(tin: TIN, path: Path) -> None:
    """Write a TIN with nothing but units, points and faces."""
    ET.register_namespace("", _SPACE)
    root = ET.Element(f"{{{_SPACE}}}LandXML", version="1.2")
    units = ET.SubElement(root, f"{{{_SPACE}}}Units")
    ET.SubElement(units, f"{{{_SPACE}}}Metric", linearUnit="meter")
    surfaces = ET.SubElement(root, f"{{{_SPACE}}}Surfaces")
    surface = ET.SubElement(surfaces, f"{{{_SPACE}}}Surface", name="surface")
    definition = ET.SubElement(surface, f"{{{_SPACE}}}Definition", surfType="TIN")
    points = ET.SubElement(definition, f"{{{_SPACE}}}Pnts")
    for k, (e, n, z) in enumerate(tin.points.tolist(), start=1):
        ET.SubElement(points, f"{{{_SPACE}}}P", id=str(k)).text = f"{n!r} {e!r} {z!r}"
    faces = ET.SubElement(definition, f"{{{_SPACE}}}Faces")
    for a, b, c in (tin.triangles.astype(np.int64) + 1).tolist():
        ET.SubElement(faces, f"{{{_SPACE}}}F").text = f"{a} {b} {c}"
    ET.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)
