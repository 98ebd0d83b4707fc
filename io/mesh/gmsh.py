"""Gmsh meshes (``.msh``) through meshio, for finite element programs.

The file is MSH 2.2 in text, which they all read. Triangles are in the physical group ``surface``.
Edges of the boundary and of lines are line elements for boundary conditions: the first in group
``boundary``, those of a line in one with its name, else its kind and number. MSH has no place for
CRS and units.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base import optional
from ...base.atomic import replacing_path
from ...base.errors import ReadError
from ...base.sentences import FILE
from ...tin.topology import NO_NEIGHBOR, edge_keys, ends
from ..isolated import run_isolated
from .common import Mesh, mesh_reader, read_content, require_tin

if TYPE_CHECKING:
    from pathlib import Path

    from ...base.arrays import Int32Array
    from ...base.progress import Tell
    from ...tin import TIN

SURFACE = "surface"
BOUNDARY = "boundary"
UNNAMED = "constrained"

_DIGITS = ".17g"
_ODD_LETTERS = re.compile(r'["\r\n]')


class _Edges(NamedTuple):
    """Edges of boundary and lines, each once, and the name of the group of each."""

    pairs: Int32Array
    names: list[str]


@mesh_reader
def read(path: Path) -> Mesh:
    """Read the faces of a Gmsh file; line elements along their edges become constrained.

    The file tells neither CRS nor unit. Quadrilaterals are cut along a diagonal, which the report
    tells; faces with nodes amid their edges are cut at these. Cells that are no faces are left out
    and told. A file of nodes alone gives a survey.
    """
    optional.require("meshio", "Reading Gmsh files")
    if not path.is_file():
        read_content(path)  # says why it cannot be read
    others, arrays = run_isolated(
        f"{__package__}.gmsh_child:read_mesh", {"path": str(path.absolute())}, path=path
    )
    listed = ", ".join(f"{count:,} of the kind {kind}" for kind, count in others.items())
    if len(arrays["corners"]) == 0 and others:
        raise ReadError(
            f"{FILE} holds no faces, but other cells ({listed}): triangles and quadrilaterals "
            "can be read."
        )
    return Mesh(
        arrays["points"],
        arrays["corners"],
        arrays["offsets"],
        notes=[f"Not read: other cells ({listed})."] * bool(others),
        constrained_edges=arrays["lines"],
    )


def write(surface: TIN, path: Path, *, progress: Tell | None = None) -> None:
    """Write a TIN as a Gmsh file, MSH 2.2 in text."""
    tin = require_tin(surface, format_name="Gmsh")
    meshio = optional.load("meshio", "Writing Gmsh files")
    edges = _gather_edges(tin)
    number_of = {name: i for i, name in enumerate(dict.fromkeys([SURFACE, *edges.names]), start=1)}
    numbers = [np.array([number_of[name] for name in edges.names], np.int32),
               np.full(len(tin.triangles), number_of[SURFACE], np.int32)]  # fmt: skip
    mesh = meshio.Mesh(
        tin.points,
        [("line", edges.pairs), ("triangle", tin.triangles)],
        cell_data={"gmsh:physical": numbers, "gmsh:geometrical": numbers},
        field_data={
            name: np.array([number, 2 if name == SURFACE else 1])
            for name, number in number_of.items()
        },
    )
    with replacing_path(path) as beside:
        meshio.gmsh.write(str(beside), mesh, fmt_version="2.2", binary=False, float_fmt=_DIGITS)
    if progress is not None:
        progress(1.0)


def _gather_edges(tin: TIN) -> _Edges:
    """Gather edges by group, the boundary first: an element has one group only."""
    triangle, corner = np.nonzero(tin.neighbors == NO_NEIGHBOR)
    groups = [(np.stack(ends(tin.triangles, triangle, corner), axis=1), BOUNDARY)]
    for number, chain in enumerate(tin.lines.chains()):
        name = tin.lines.names[number] or f"{tin.lines.kinds[number]} {tin.lines.sources[number]}"
        groups.append((np.stack([chain[:-1], chain[1:]], axis=1), _ODD_LETTERS.sub("_", name)))
    triangle, corner = np.nonzero(tin.constrained)
    groups.append((np.stack(ends(tin.triangles, triangle, corner), axis=1), UNNAMED))
    pairs = np.concatenate([pairs for pairs, _ in groups]).astype(np.int32)
    names = [name for pairs, name in groups for _ in range(len(pairs))]
    _, first = np.unique(edge_keys(pairs, len(tin.points)), return_index=True)
    first.sort()
    return _Edges(pairs[first], [names[i] for i in first.tolist()])
