"""What a format loses of a TIN or of points: written, read back and compared."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import tinsmith as ts
from tinsmith.tin import topology

SITE = [431_210.25, 3_984_120.5]


def make_survey():
    """Return points with attributes, CRS, unit of elevations and a note."""
    rng = np.random.default_rng(14)
    xy = rng.random((40, 2)) * [220, 180] + SITE
    corners = np.array([[0, 0], [230, 0], [230, 190], [0, 190]]) + SITE
    points = np.c_[np.r_[corners, xy], rng.random(44) * 12 + 300]
    points[7] = [SITE[0] + 50.1, SITE[1] + 1 / 3, 301.123456789012]
    return ts.Survey(
        points=points,
        attributes={
            "number": np.arange(1, 45),
            "description": np.array([f"GND {n}" for n in range(44)], object),
        },
        crs="EPSG:32616",
        elevation_unit="m",
    )


def _place(*xy):
    return (np.array(xy, float) + SITE).tolist()


def make_survey_with_lines():
    """Return the same with lines of every kind."""
    return replace(
        make_survey(),
        breaklines=[
            ts.Breakline([[*_place(10, 10), 302], [*_place(200, 120), 306]], name="kerb"),
            ts.Breakline(
                [[*_place(20, 150), 304], [*_place(190, 40), 308]],
                kind="soft",
                name="ridge",
                priority=-2,
            ),
            ts.Breakline([_place(40, 170), _place(90, 160)], name="draped"),
        ],
        boundary=[_place((0, 0), (225, 5), (228, 185), (2, 188))],
        holes=[
            _place((60, 20), (80, 22), (70, 40)),
            [_place((10, 100), (40, 100), (25, 140)), _place((20, 105), (30, 105), (25, 115))],
        ],
        erase=[_place((160, 140), (180, 142), (170, 160))],
        water=[ts.Water(_place((120, 120), (150, 122), (140, 150)), 299.5, name="pond")],
    )


def make_tin():
    """Return a constrained TIN with attributes, lines of every kind, CRS and unit."""
    survey = make_survey_with_lines()
    return ts.triangulate(
        replace(
            survey,
            breaklines=survey.breaklines[:2],
            holes=(),
            erase=(),
            notes=["the unit was guessed"],
        )
    )


def measure_rounding(given, found):
    """Return how far points lie from those that were written, in each axis; None if not the same.

    Points may come in another order: each is compared with the nearest.
    """
    if len(given) == 0 or len(found) == 0:
        return None
    from scipy.spatial import cKDTree

    distances, nearest = cKDTree(found).query(given)
    if not np.isfinite(distances).all():
        return None
    return float(np.abs(found[nearest] - given).max())


def find_losses_of_tin(given, found):
    """Return words for what is not as in the TIN that was written."""
    lost = _find_losses_of_reference(given, found) | _find_losses_of_attributes(given, found)
    if not isinstance(found, ts.TIN):
        return lost | {"triangles", "constrained", "lines", "report", "order", "notes"} - (
            {"order"} if _is_same_order(given, found) else set()
        )
    if not _is_same_order(given, found):
        lost.add("order")
    if _edges(given, given.constrained) != _edges(found, found.constrained, given):
        lost.add("constrained")
    if _chains(given, given) != _chains(found, given):
        lost.add("lines")
    if found.report.to_dict() != given.report.to_dict():
        lost.add("report")
    if list(found.report.notes)[: len(given.report.notes)] != list(given.report.notes):
        lost.add("notes")
    if not _have_same_triangles(given, found):
        lost.add("triangles")
    return lost


def find_losses_of_survey(given, found):
    """Return words for what is not as in the survey that was written."""
    lost = _find_losses_of_reference(given, found)
    if not isinstance(found, ts.Survey):
        return lost | {"attributes"}
    if not _is_same_order(given, found):
        lost.add("order")
    for name, column in given.attributes.items():
        if name not in found.attributes or list(found.attributes[name]) != list(column):
            lost.add("attributes")
    return lost | _find_lost_lines(given, found)


def _find_lost_lines(given, found):
    """Compare what each line is by its coordinates, bit for bit."""
    kinds = ("breaklines", "boundary", "holes", "erase", "water")
    lost = {kind for kind in kinds if _list_lines(given, kind) != _list_lines(found, kind)}
    if lost == {"erase"}:
        return {"erased areas"}
    return {"survey lines"} if lost else set()


def _list_lines(survey, kind):
    lines = []
    for line in getattr(survey, kind):
        match line:
            case ts.Breakline():
                told = (line.name, line.kind, line.priority, line.is_draped)
                lines.append((*told, _list_places(line.coords)))
            case ts.Water():
                lines.append((line.name, line.z, _list_places(line.ring)))
            case _:
                rings = [line] if np.ndim(line[0][0]) == 0 else line
                lines.append([_list_places(ring) for ring in rings])
    return lines


def _list_places(line):
    return [tuple(row[:2]) for row in np.asarray(line, float).tolist()]


def _find_losses_of_attributes(given, found):
    """Compare attributes place by place: a mesh may number its vertices anew."""
    number = _match(found, given)
    for name, column in given.attributes.items():
        wanted = column[number].tolist()
        kept = np.asarray(found.attributes.get(name, np.full(len(number), None))).tolist()
        if any(a != b and (a == a or b == b) for a, b in zip(wanted, kept, strict=True)):
            return {"attributes"}
    return set()


def _find_losses_of_reference(given, found):
    lost = set()
    if found.crs is None or not found.crs.is_same(given.crs):
        lost.add("crs")
    if found.elevation_unit != given.elevation_unit:
        lost.add("elevation unit")
    return lost


def _is_same_order(given, found):
    if len(given.points) != len(found.points):
        return False
    if isinstance(found, ts.TIN) and len(found.triangles) != len(given.triangles):
        return False
    is_close = np.abs(given.points - found.points).max() < 0.01
    return bool(is_close) and (
        not isinstance(found, ts.TIN) or (found.triangles == given.triangles).all()
    )


def _match(found, given):
    """Return the given vertex nearest to each found one."""
    from scipy.spatial import cKDTree

    return cKDTree(given.points[:, :2]).query(found.points[:, :2])[1]


def _edges(tin, flags, given=None):
    edges = topology.edges_at(tin.triangles, flags)
    edges = edges if given is None else _match(tin, given)[edges]
    return {tuple(sorted(edge)) for edge in edges.tolist()}


def _chains(tin, given):
    number = _match(tin, given)
    return sorted(
        (kind, name, tuple(number[chain].tolist()))
        for kind, name, chain in zip(
            tin.lines.kinds, tin.lines.names, tin.lines.chains(), strict=True
        )
    )


def _have_same_triangles(given, found):
    number = _match(found, given)
    return {tuple(sorted(one)) for one in number[found.triangles].tolist()} == {
        tuple(sorted(one)) for one in given.triangles.tolist()
    }
