# Types of the compiled core; what it does is said in terrain/_kernel.py.
from collections.abc import Callable
from typing import Final

from ..base.arrays import BoolArray, Float64Array, Int8Array, Int32Array, Int64Array, UInt8Array

TILE_SIDE: int

class GriddedSurface:
    def __init__(self, points: Float64Array, triangles: Int32Array) -> None: ...
    def values_at_centers(
        self,
        x: Float64Array,
        y: Float64Array,
        size: tuple[float, float],
        values: Float64Array | None,
        threads: int = ...,
        progress: Callable[[float], None] | None = ...,
    ) -> Float64Array: ...
    def triangles_at_centers(
        self,
        x: Float64Array,
        y: Float64Array,
        size: tuple[float, float],
        values: Float64Array,
        threads: int = ...,
        progress: Callable[[float], None] | None = ...,
    ) -> tuple[Float64Array, Int64Array, Int64Array]: ...
    def vectors_at_centers(
        self,
        x: Float64Array,
        y: Float64Array,
        size: tuple[float, float],
        vectors: Float64Array,
        threads: int = ...,
        progress: Callable[[float], None] | None = ...,
    ) -> Float64Array: ...
    def means_of_cells(
        self,
        x: Float64Array,
        y: Float64Array,
        size: tuple[float, float],
        x_edges: Float64Array,
        y_edges: Float64Array,
        values: Float64Array | None,
        threads: int = ...,
        progress: Callable[[float], None] | None = ...,
    ) -> Float64Array: ...

def number_components(neighbors: Int32Array) -> Int64Array: ...
def double_areas(
    points: Float64Array, triangles: Int32Array, threads: int = ...
) -> Float64Array: ...
def join_components(count: int, one: Int64Array, other: Int64Array) -> Int64Array: ...

class ContourLines:
    coordinates: Final[Float64Array]
    offsets: Final[Int64Array]
    level: Final[Int32Array]
    is_closed: Final[BoolArray]
    length: Final[Float64Array]

class LinePieces:
    points: Final[Float64Array]
    offsets: Final[Int64Array]
    level: Final[Int32Array]
    first: Final[Int64Array]
    next: Final[Int64Array]

class BandBoundaries:
    segments: Final[Float64Array]
    offsets: Final[Int64Array]

def trace_pieces(
    points: Float64Array,
    triangles: Int32Array,
    neighbors: Int32Array,
    levels: Float64Array,
    is_owned: BoolArray,
    names: Int64Array,
) -> LinePieces: ...
def settle_contours(
    coordinates: Float64Array,
    offsets: Int64Array,
    line_levels: Int32Array,
    are_closed: BoolArray,
    levels: Float64Array,
) -> ContourLines: ...
def list_band_boundaries(
    points: Float64Array,
    triangles: Int32Array,
    neighbors: Int32Array,
    levels: Float64Array,
    is_owned: BoolArray,
) -> BandBoundaries: ...
def fill_band(segments: Float64Array, band: int) -> BandPolygons: ...

class BandPolygons:
    points: Final[Float64Array]
    ring_offsets: Final[Int64Array]
    polygon_offsets: Final[Int64Array]
    band: Final[Int32Array]

def trace_contours(
    points: Float64Array,
    triangles: Int32Array,
    neighbors: Int32Array,
    levels: Float64Array,
) -> ContourLines: ...
def fill_bands(
    points: Float64Array,
    triangles: Int32Array,
    neighbors: Int32Array,
    levels: Float64Array,
) -> BandPolygons: ...
def smooth_contours(
    points: Float64Array,
    triangles: Int32Array,
    neighbors: Int32Array,
    levels: Float64Array,
    lines: ContourLines,
    places: Int32Array,
    smooth: float,
    rounds: int,
    simplify: float,
) -> ContourLines: ...
def sum_between(
    points: Float64Array,
    triangles: Int32Array,
    groups: Int32Array,
    group_count: int,
    other_points: Float64Array,
    other_triangles: Int32Array,
    up: float,
    is_other_apart: bool = ...,
    threads: int = ...,
    progress: Callable[[float], None] | None = ...,
) -> Float64Array: ...
def sum_heights(
    points: Float64Array,
    triangles: Int32Array,
    heights: Float64Array,
    groups: Int32Array,
    group_count: int,
    up: float,
) -> Float64Array: ...
def sum_areas(
    points: Float64Array,
    triangles: Int32Array,
    groups: Int32Array,
    group_count: int,
) -> Float64Array: ...
def terms_between(
    points: Float64Array,
    triangles: Int32Array,
    groups: Int32Array,
    group_count: int,
    other_points: Float64Array,
    other_triangles: Int32Array,
    up: float,
    is_other_apart: bool = ...,
    threads: int = ...,
) -> SumTerms: ...
def terms_of_heights(
    points: Float64Array,
    triangles: Int32Array,
    heights: Float64Array,
    groups: Int32Array,
    group_count: int,
    up: float,
) -> SumTerms: ...
def terms_of_areas(
    points: Float64Array,
    triangles: Int32Array,
    groups: Int32Array,
    group_count: int,
) -> Float64Array: ...
def sum_rows(rows: Float64Array) -> Float64Array: ...
def merge_terms(rows: Float64Array) -> Float64Array: ...

class SumTerms:
    terms: Final[Float64Array]
    extremes: Final[Float64Array]

def overlay(
    points: Float64Array,
    triangles: Int32Array,
    other_points: Float64Array,
    other_triangles: Int32Array,
    *,
    is_other_apart: bool = ...,
) -> OverlayMesh: ...

class OverlayMesh:
    vertices: Final[Float64Array]
    origins: Final[Int32Array]
    offsets: Final[Int64Array]
    corners: Final[Int32Array]
    triangles: Final[Int32Array]

def stage_sums(
    points: Float64Array,
    triangles: Int32Array,
    levels: Float64Array,
    up: float,
) -> Float64Array: ...
def triangle_normals(
    points: Float64Array,
    triangles: Int32Array,
    threads: int = ...,
) -> tuple[Float64Array, Int32Array]: ...
def vertex_normals(
    points: Float64Array,
    triangles: Int32Array,
    normals: Float64Array,
    threads: int = ...,
) -> Float64Array: ...
def fit_quadratics(
    points: Float64Array,
    triangles: Int32Array,
    east: Float64Array,
    north: Float64Array,
    up: float,
    threads: int = ...,
) -> Float64Array: ...
def complete_sides(
    points: Float64Array,
    counts: Int64Array,
    corners: Int64Array,
    lines: Int64Array,
    line_count: int,
) -> tuple[Int64Array, Int64Array, Int64Array]: ...
def find_seen_parts(
    points: Float64Array,
    triangles: Int32Array,
    neighbors: Int32Array,
    eye: Float64Array,
    target_height: float,
    threads: int = ...,
) -> SeenParts: ...

class SeenParts:
    parts: Final[UInt8Array]
    offsets: Final[Int64Array]
    triangles: Final[Int32Array]
    is_seen: Final[BoolArray]
    corners: Final[Float64Array]
    lines: Final[Int64Array]

def find_seen_vertices(
    points: Float64Array,
    triangles: Int32Array,
    neighbors: Int32Array,
    wanted: BoolArray,
    eye: Float64Array,
    target_height: float,
    radius: float,
    fall: float,
    threads: int = ...,
) -> UInt8Array: ...
def shade_planes(
    normals: Float64Array,
    east: float,
    north: float,
    up: float,
    darkest: int,
    brightest: int,
) -> UInt8Array: ...
def densify(
    seeds: Float64Array,
    triangles: Int32Array,
    neighbors: Int32Array,
    points: Float64Array,
    is_candidate: BoolArray,
    sine: float,
    distance: float,
    full_edge: float,
    progress: Callable[[float], None] | None = None,
) -> tuple[Float64Array, Float64Array]: ...
def simplify_cells(
    x: Float64Array,
    y: Float64Array,
    z: Float64Array,
    vertex_cells: Int32Array,
    vertices: Float64Array,
    triangles: Int32Array,
    neighbors: Int32Array,
    fixed: BoolArray,
    tolerance: float,
    most: int,
    prunes: bool,
    path: str = ...,
) -> tuple[Int32Array, int]: ...
def measure_cells(
    z: Float64Array, cells: Int32Array, elevations: Float64Array, triangles: Int32Array
) -> Float64Array: ...

class Filling:
    def __init__(
        self,
        levels: Float64Array,
        ponds: Int64Array,
        nexts: Int64Array,
        steps: Int64Array,
        ranks: Int64Array,
    ) -> None: ...

class Bases:
    edges: Final[Int64Array]
    splits: Final[Float64Array]
    drains: Final[BoolArray]

class FallingSurface:
    def __init__(
        self,
        points: Float64Array,
        triangles: Int32Array,
        neighbors: Int32Array,
        signs: Int8Array,
        values: Float64Array,
        filling: Filling | None,
    ) -> None: ...
    def bases_of(self, triangles: Int64Array) -> Bases: ...
    def cut_strips(self, most: int) -> tuple[Int64Array, Float64Array]: ...
    def measure_strips(
        self, offsets: Int64Array, starts: Float64Array, areas: Float64Array
    ) -> Float64Array: ...
    def link_strips(
        self,
        offsets: Int64Array,
        starts: Float64Array,
        grounds: Int32Array,
        threads: int = ...,
    ) -> tuple[Int32Array, Int32Array]: ...
    def link_vertices(
        self,
        is_boundary: BoolArray,
        strip_count: int,
        grounds: Int32Array,
        threads: int = ...,
    ) -> tuple[Int32Array, Int32Array, Int32Array]: ...

def find_ends(nexts: Int32Array) -> Int32Array: ...
def accumulate(nexts: Int32Array, totals: Float64Array) -> None: ...
def sum_channels(
    uppers: Int32Array,
    nexts: Int32Array,
    totals: Float64Array,
    vertex_count: int,
) -> tuple[Int32Array, Float64Array]: ...
def cut_cells(
    corners: Int32Array,
    ranges: Int64Array,
    first_place: int,
    offsets: Int64Array,
    lower: Int32Array,
    upper: Int32Array,
) -> tuple[Int64Array, Int64Array, Int32Array]: ...
