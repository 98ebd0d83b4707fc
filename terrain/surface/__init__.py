"""What products share: places, lines and polygons on a surface, and its measures."""

from .breaks import CROSSED, Breaks, trace_breaks
from .cells import Pieces, cut_pieces, fan_out, turns
from .dissolving import (
    DividedMesh,
    Mesh,
    dissolve,
    join_components,
    make_polygons,
    number_components,
)
from .geometries import as_features
from .light import Light, PlaneMeasure, as_light, normalise
from .normals import (
    compute_normals,
    measure_areas,
    measure_aspects,
    measure_plane_areas,
    measure_ring_area,
    measure_slopes,
    sum_at_vertices,
    sum_normals,
)
from .places import as_places
from .polygons import (
    PolygonParts,
    as_parts,
    has_area,
    is_whole,
    measure_lengths,
    measure_ring_areas,
    repair_polygons,
    require_whole,
    sum_parts,
    take_polygons,
)
from .reference import (
    Reference,
    Surface,
    agree_on_reference,
    find_common_reference,
    find_reference,
    make_reference,
    require_finite,
)
from .roundings import find_rounding, find_written_rounding
from .segments import Segments, as_segments
from .slivers import (
    find_slivers,
    find_thin,
    keep_triangles,
    leave_out_slivers,
    measure_rounding,
    take_without_slivers,
)
from .voids import find_border, find_surface, trace_cycles, trace_rings

__all__ = [
    "CROSSED",
    "Breaks",
    "DividedMesh",
    "Light",
    "Mesh",
    "Pieces",
    "PlaneMeasure",
    "PolygonParts",
    "Reference",
    "Segments",
    "Surface",
    "agree_on_reference",
    "as_features",
    "as_light",
    "as_parts",
    "as_places",
    "as_segments",
    "compute_normals",
    "cut_pieces",
    "dissolve",
    "fan_out",
    "find_border",
    "find_common_reference",
    "find_reference",
    "find_rounding",
    "find_slivers",
    "find_surface",
    "find_thin",
    "find_written_rounding",
    "has_area",
    "is_whole",
    "join_components",
    "keep_triangles",
    "leave_out_slivers",
    "make_polygons",
    "make_reference",
    "measure_areas",
    "measure_aspects",
    "measure_lengths",
    "measure_plane_areas",
    "measure_ring_area",
    "measure_ring_areas",
    "measure_rounding",
    "measure_slopes",
    "normalise",
    "number_components",
    "repair_polygons",
    "require_finite",
    "require_whole",
    "sum_at_vertices",
    "sum_normals",
    "sum_parts",
    "take_polygons",
    "take_without_slivers",
    "trace_breaks",
    "trace_cycles",
    "trace_rings",
    "turns",
]
