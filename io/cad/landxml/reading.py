"""Read LandXML: a surface with its own triangles, its source data, or the survey points."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ....base.errors import OptionError, ReadError, choice
from ....base.policies import DrawingContent, FacePolicy
from ....base.sentences import FILE, counted, shown
from ..drawing import Drawing
from ..reference import Declared, choose_measures
from .content import Content, Surface
from .parser import parse
from .source import gather_points, gather_source
from .surface import list_edge_lines, make_mesh
from .units import find_stated

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.crs import CrsLike, UnitLike
    from ....tin import TIN, Survey

_SAMPLE = 64


def read(
    path: Path,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    unit: UnitLike | None = None,
    surface: str | int | None = None,
    content: DrawingContent | None = None,
    faces: FacePolicy = "most",
) -> TIN | Survey:
    """Read a LandXML file, version 1.0 to 2.0.

    A TIN has the file's own triangles; source data and points are a survey, which is reprojected to
    ``crs``. What was assumed or left out is in the notes.

    Parameters
    ----------
    unit : Unit or str, optional
        Declares the unit of coordinates and elevations, where the file does not say, or where it
        says another one than its CRS.
    surface : str or int, optional
        Name of the surface, or its number in the file, from 1; needed if several have faces.
    content : {"surface", "source", "points"}, optional
        The triangles of a surface; the data that it was made of, with breaklines and boundaries;
        or the survey points (CgPoints). Default the first of these that the file has.

    Raises
    ------
    ReadError
        Also if there is nothing of the kind, several surfaces and no name is given, a grid surface,
        no units and none are declared, or units that the CRS does not have.
    CrsError
        Also if a TIN is in another CRS.

    Notes
    -----
    Read as a stream, without document types, entities and references to other files. Invisible
    faces are skipped.
    """
    if content is not None:
        choice("content", content, DrawingContent)
    wanted = surface.strip() if isinstance(surface, str) else surface
    if wanted == "" or isinstance(wanted, bool) or not isinstance(wanted, str | int | None):
        raise OptionError("surface", surface, "the name of a surface, or its number from 1")
    declared = Declared.of(crs, unit, elevation_unit)
    found = parse(path, surface=wanted, points_only=content == "points")
    chosen = None if content == "points" else _choose_surface(found, wanted, content)
    kind = content or _choose_content(found, chosen)
    notes = _describe_rest(found, chosen, kind)
    if kind != "points" and chosen is None:
        has = "source data" if kind == "source" else "visible faces"
        raise ReadError(f"{FILE} has no surface with {has}.")
    if chosen is None:
        rows = found.points.rows
    else:
        rows = np.concatenate(
            [np.empty((0, 2))]
            + [one[:, :2] for one in chosen.points]
            + [part[:, :2] for line in chosen.lines for part in line.coordinates]
        )
        if not len(rows):
            rows = found.points.rows
    rows = rows[np.isfinite(rows[:, :2]).all(axis=1)]
    sample = rows[:: max(1, len(rows) // _SAMPLE), [1, 0]]
    stated, said = find_stated(found, sample=sample, is_crs_declared=declared.crs is not None)
    system = stated.crs or declared.crs
    units = (stated.unit, declared.unit, declared.elevation_unit)
    if all(one is None for one in units) and (system is None or system.vertical_unit is None):
        raise ReadError(
            f"{FILE} does not say its units: declare that of the elevations, such as "
            "`elevation_unit='m'` or `elevation_unit='US survey foot'`, or that of all lengths, "
            "`unit='ft'`."
        )
    measures = (
        choose_measures(stated, declared, sample=sample)
        .noting(*said, first=True)
        .noting(*notes, first=True)
    )
    frame = Drawing(path=path, measures=measures, declared=declared, names_axes=True)
    if chosen is None:
        return gather_points(found.points, frame).to_survey()
    if kind == "source":
        return gather_source(found, chosen, frame).to_survey()
    drawing = replace(frame, mesh=make_mesh(found, chosen), lines=list_edge_lines(chosen))
    return drawing.to_tin(faces).with_name(chosen.name)


# ------------------------------------------------------------------ what is read


def _choose_surface(
    found: Content, wanted: str | int | None, content: str | None
) -> Surface | None:
    """Return the surface wanted, else the only one that has what is wanted; None if none has."""
    if wanted is not None:
        named = [one for one in found.surfaces if one.name == wanted]
        if len(named) > 1:
            numbers = ", ".join(str(one.number) for one in named)
            raise ReadError(
                f"{FILE} has {len(named)} surfaces of the name {shown(wanted)}: choose one by its "
                f"number in the file ({numbers})."
            )
        numbered = [one for one in found.surfaces if str(one.number) == str(wanted)]
        if named or numbered:
            return (named or numbered)[0]
        allowed = _list_surfaces(found.surfaces) or "none: the file has no surface"
        raise OptionError("surface", wanted, f"one of those in {FILE}, {allowed}")
    with_faces = [one for one in found.surfaces if one.n_visible]
    with_source = [one for one in found.surfaces if one.has_source]
    if content == "source":
        fitting = with_source
    else:
        fitting = with_faces or (with_source if content is None else [])
    if len(fitting) > 1:
        raise ReadError(
            f"{FILE} has {len(fitting)} surfaces ({_list_surfaces(fitting)}): name the one to "
            "read by the option `surface`."
        )
    return fitting[0] if fitting else None


def _list_surfaces(surfaces: list[Surface]) -> str:
    names = [one.label for one in surfaces[:20]]
    return ", ".join(names) + (", ..." if len(surfaces) > len(names) else "")


def _choose_content(found: Content, chosen: Surface | None) -> str:
    if chosen is not None and (chosen.n_visible or not chosen.has_source):
        return "surface"
    has_points = len(found.points) > 0
    if chosen is not None and has_points and _has_own_points(chosen):
        raise ReadError(
            f"{FILE} has no faces, but the source data of a surface and "
            f"{counted(len(found.points), 'survey point')}: choose `content='source'` or "
            "`content='points'`."
        )
    if chosen is not None:
        return "source"
    if has_points:
        return "points"
    count = found.others.get("alignment", 0)
    hint = f" It has {counted(count, 'alignment')}: see read_alignment." if count else ""
    raise ReadError(
        f"{FILE} has neither a surface with visible faces, nor source data or survey points.{hint}"
    )


def _has_own_points(surface: Surface) -> bool:
    return any(line.element in ("DataPoints", "Contour") for line in surface.lines)


def _describe_rest(found: Content, chosen: Surface | None, kind: str) -> list[str]:
    notes = []
    others = [one for one in found.surfaces if one is not chosen]
    if kind != "points" and others:
        notes.append(f"Not read: {counted(len(others), 'surface')} ({_list_surfaces(others)}).")
    if kind == "points" and found.surfaces:
        notes.append(f"Not read: {counted(len(found.surfaces), 'surface')}.")
    if kind == "surface" and len(found.points):
        notes.append(
            f"Not read: {counted(len(found.points), 'survey point')}, which "
            "`content='points'` gives."
        )
    if found.others:
        listed = ", ".join(counted(n, what) for what, n in found.others.items())
        notes.append(f"Not read: {listed}.")
    if kind == "source" and chosen is not None and not chosen.n_visible:
        notes.append("There are no visible faces: the source data were read.")
    return notes
