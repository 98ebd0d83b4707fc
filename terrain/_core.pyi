# Types of the compiled core; what it does is said in terrain/_kernel.py.
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Doubles: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int32]
Longs: TypeAlias = NDArray[np.int64]
Flags: TypeAlias = NDArray[np.bool_]
Bytes: TypeAlias = NDArray[np.uint8]

TILE_SIDE: int

class GriddedSurface:
    def __init__(self, points: Doubles, triangles: Ints) -> None: ...
    def values_at_centers(
        self,
        x: Doubles,
        y: Doubles,
        spacing: float,
        values: Doubles | None,
        threads: int = ...,
        progress: Callable[[float], None] | None = ...,
    ) -> Doubles: ...
    def means_of_cells(
        self,
        x: Doubles,
        y: Doubles,
        spacing: float,
        x_edges: Doubles,
        y_edges: Doubles,
        values: Doubles | None,
        threads: int = ...,
        progress: Callable[[float], None] | None = ...,
    ) -> Doubles: ...

class LeaveOneOut:
    def __init__(self, points: Doubles, triangles: Ints, neighbors: Ints) -> None: ...
    def interpolate(self, vertices: Ints, threads: int = ...) -> Doubles: ...
    def list_neighbors(self, vertices: Ints) -> tuple[Longs, Ints]: ...

def trace_contours(
    points: Doubles,
    triangles: Ints,
    neighbors: Ints,
    levels: Doubles,
) -> tuple[
    Doubles,
    Longs,
    Ints,
    Flags,
    Doubles,
]: ...
def fill_bands(
    points: Doubles,
    triangles: Ints,
    neighbors: Ints,
    levels: Doubles,
) -> tuple[Doubles, Longs, Longs, Ints]: ...
def smooth_contours(
    points: Doubles,
    triangles: Ints,
    neighbors: Ints,
    levels: Doubles,
    xyz: Doubles,
    offsets: Longs,
    level: Ints,
    is_closed: Flags,
    places: Ints,
    smooth: float,
    rounds: int,
    simplify: float,
) -> tuple[
    Doubles,
    Longs,
    Ints,
    Flags,
    Doubles,
]: ...
def sum_between(
    points: Doubles,
    triangles: Ints,
    groups: Ints,
    group_count: int,
    other_points: Doubles,
    other_triangles: Ints,
    up: float,
    threads: int = ...,
    progress: Callable[[float], None] | None = ...,
) -> Doubles: ...
def sum_heights(
    points: Doubles,
    triangles: Ints,
    heights: Doubles,
    groups: Ints,
    group_count: int,
    up: float,
) -> Doubles: ...
def sum_areas(
    points: Doubles,
    triangles: Ints,
    groups: Ints,
    group_count: int,
) -> Doubles: ...
def overlay(
    points: Doubles,
    triangles: Ints,
    other_points: Doubles,
    other_triangles: Ints,
) -> tuple[
    Doubles,
    Ints,
    Longs,
    Ints,
    Ints,
]: ...
def stage_sums(
    points: Doubles,
    triangles: Ints,
    levels: Doubles,
    up: float,
) -> Doubles: ...
def triangle_normals(
    points: Doubles,
    triangles: Ints,
    threads: int = ...,
) -> tuple[Doubles, Ints]: ...
def vertex_normals(
    points: Doubles,
    triangles: Ints,
    normals: Doubles,
) -> Doubles: ...
def fit_quadratics(
    points: Doubles,
    triangles: Ints,
    east: Doubles,
    north: Doubles,
    up: float,
    threads: int = ...,
) -> Doubles: ...
def find_seen_parts(
    points: Doubles,
    triangles: Ints,
    neighbors: Ints,
    eye: Doubles,
    target_height: float,
    threads: int = ...,
) -> tuple[Bytes, Longs, Ints, Bytes, Doubles, Longs]: ...
def find_seen_vertices(
    points: Doubles,
    triangles: Ints,
    neighbors: Ints,
    wanted: Flags,
    eye: Doubles,
    target_height: float,
    radius: float,
    fall: float,
    threads: int = ...,
) -> Bytes: ...
def measure_neighbors(points: Doubles, triangles: Ints) -> Doubles: ...
def shade_planes(
    normals: Doubles,
    east: float,
    north: float,
    up: float,
    darkest: int,
    brightest: int,
) -> Bytes: ...
def densify(
    seeds: Doubles,
    points: Doubles,
    is_candidate: Flags,
    sine: float,
    distance: float,
    full_edge: float,
    progress: Callable[[float], None] | None = None,
) -> tuple[Doubles, Doubles]: ...
def simplify_cells(
    x: Doubles,
    y: Doubles,
    z: Doubles,
    vertex_cells: Ints,
    vertices: Doubles,
    triangles: Ints,
    neighbors: Ints,
    fixed: Flags,
    tolerance: float,
    most: int,
    prunes: bool,
    path: str = ...,
) -> tuple[Ints, int]: ...
def measure_cells(z: Doubles, cells: Ints, elevations: Doubles, triangles: Ints) -> Doubles: ...

class FallingSurface:
    def __init__(
        self,
        points: Doubles,
        triangles: Ints,
        neighbors: Ints,
        signs: NDArray[np.int8],
        values: Doubles,
        levels: tuple[Doubles, Longs, Longs, Longs, Longs] | None,
    ) -> None: ...
    def bases_of(self, triangles: Longs) -> tuple[Longs, Doubles, Flags]: ...
    def cut_strips(self, most: int) -> tuple[Longs, Doubles]: ...
    def measure_strips(self, offsets: Longs, starts: Doubles, areas: Doubles) -> Doubles: ...
    def link_strips(self, offsets: Longs, starts: Doubles, grounds: Ints) -> tuple[Ints, Ints]: ...
    def link_vertices(
        self, is_boundary: Flags, strip_count: int, grounds: Ints
    ) -> tuple[Ints, Ints, Ints]: ...

def find_ends(nexts: Ints) -> Ints: ...
def accumulate(nexts: Ints, totals: Doubles) -> None: ...
def sum_channels(
    uppers: Ints,
    nexts: Ints,
    totals: Doubles,
    vertex_count: int,
) -> tuple[Ints, Doubles]: ...
def cut_cells(
    corners: Ints,
    ranges: Longs,
    first_place: int,
    offsets: Longs,
    lower: Ints,
    upper: Ints,
) -> tuple[Longs, Longs, Ints]: ...
