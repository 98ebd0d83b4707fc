import enum
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Doubles: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int32]
Longs: TypeAlias = NDArray[np.int64]
Signs: TypeAlias = NDArray[np.int8]
Flags: TypeAlias = NDArray[np.bool_]

SMALLEST_COORDINATE: float
MOST_POINTS: int
LARGEST_COORDINATE: float

class Method(enum.Enum):
    AUTOMATIC = 0
    GROWTH = 1
    INSERTION = 2

def vector_paths() -> list[str]: ...
def join_triangles(triangles: Ints, vertex_count: int) -> tuple[Ints, bool]: ...
def turns_of_triangles(points: Doubles, triangles: Ints) -> Signs: ...
def are_in_exact_range(xy: Doubles) -> bool: ...
def clean(points: Doubles, threads: int = ...) -> tuple[Doubles, bool]: ...
def grow(
    points: Doubles,
    method: Method = ...,
    threads: int = ...,
    path: str = ...,
    progress: Callable[[float], None] | None = ...,
) -> tuple[Ints, Ints, Ints | None, int]: ...
def count_work(
    points: Doubles, method: Method = ..., threads: int = ..., path: str = ...
) -> dict[str, int]: ...
def snap(points: Doubles, distance: float) -> Ints: ...
def orientation(a: Doubles, b: Doubles, c: Doubles) -> Signs: ...
def compare_distances(v: Doubles, p: Doubles, q: Doubles) -> Signs: ...
def in_circle(
    a: Doubles,
    b: Doubles,
    c: Doubles,
    d: Doubles,
) -> Signs: ...

class Locator:
    def __init__(
        self,
        points: Doubles,
        triangles: Ints,
        neighbors: Ints,
    ) -> None: ...
    def locate(self, xy: Doubles) -> Ints: ...
    def interpolate(self, xy: Doubles, threads: int = ...) -> Doubles: ...
    def trace(
        self, starts: Doubles, ends: Doubles
    ) -> tuple[
        Longs,
        Doubles,
        Doubles,
        Doubles,
        Ints,
        Ints,
        Ints,
        Ints,
        int,
    ]: ...

class NaturalWeights(enum.Enum):
    SIBSON = 0
    LAPLACE = 1

class NaturalNeighbors:
    def __init__(self, locator: Locator, barriers: Flags) -> None: ...
    def interpolate(self, xy: Doubles, kind: NaturalWeights, threads: int = ...) -> Doubles: ...
    @property
    def is_flipped(self) -> bool: ...

class SmoothPatches:
    def __init__(self, locator: Locator, barriers: Flags, threads: int = ...) -> None: ...
    def interpolate(self, xy: Doubles, threads: int = ...) -> Doubles: ...
    def on_edges(self, edges: Ints, shares: Doubles) -> Doubles: ...
    def gradients(self) -> Doubles: ...

def nearest_vertices(locator: Locator, xy: Doubles, threads: int = ...) -> Doubles: ...

class NearestBoundary:
    def __init__(self, locator: Locator) -> None: ...
    def find(self, xy: Doubles) -> tuple[Ints, Doubles]: ...

class Mesh:
    def __init__(
        self,
        points: Doubles,
        triangles: Ints,
        neighbors: Ints,
        fixed: Flags | None = None,
    ) -> None: ...
    @property
    def slots(self) -> int: ...
    @property
    def count(self) -> int: ...
    def alive(self) -> Flags: ...
    def has_fixed_edge(self, vertex: int) -> bool: ...
    def insert(self, xy: Doubles) -> Ints: ...
    def put(self, slot: int, x: float, y: float) -> int: ...
    def remove(self, vertices: Ints) -> bool: ...
    def force(self, segments: Ints) -> tuple[Ints, Ints]: ...
    def crossed(self, segments: Ints, only_fixed: bool = ...) -> Ints: ...
    def fixed_neighbors(self, vertex: int) -> Ints: ...
    def clearance(self, vertex: int) -> float: ...
    def corners_beside(self, a: int, b: int) -> Ints: ...
    def illegal_fixed_edges(self) -> Ints: ...
    @property
    def fixed_splits(self) -> int: ...
    def release(self, segments: Ints) -> int: ...
    def arrays(self, threads: int = ...) -> tuple[Ints, Ints, Flags]: ...

def simplify(
    points: Doubles,
    vertex_rows: Ints,
    holders: Ints,
    vertices: Doubles,
    triangles: Ints,
    neighbors: Ints,
    fixed: Flags,
    tolerance: float,
    most: int,
    prunes: bool,
) -> tuple[Ints, int]: ...
def refine(
    points: Doubles,
    triangles: Ints,
    neighbors: Ints,
    fixed: Flags,
    kept_whole: Ints,
    least_angle: float,
    largest_area: float,
    longest_edge: float,
    most: int,
    progress: Callable[[float], None] | None = None,
) -> tuple[Doubles, Ints, Ints, int, bool]: ...
def regions(
    points: Doubles,
    triangles: Ints,
    neighbors: Ints,
    barrier: Flags,
) -> tuple[Ints, Ints]: ...
def crossings(
    xy: Doubles,
    segments: Ints,
    first_new: int = ...,
    threads: int = ...,
) -> Ints: ...
def touches(
    xy: Doubles,
    segments: Ints,
    distance: float = ...,
    first_vertex: int = ...,
    is_rounded: bool = ...,
    threads: int = ...,
) -> Ints: ...
def contacts(
    xy: Doubles,
    segments: Ints,
    distance: float = ...,
    threads: int = ...,
) -> tuple[Ints, Ints]: ...
def intersections(xy: Doubles, segments: Ints, pairs: Ints) -> Doubles: ...
def vertices_at(xy: Doubles, queries: Doubles) -> Ints: ...
def points_in_polygons(
    xy: Doubles,
    ring_xy: Doubles,
    offsets: Ints,
    threads: int = ...,
) -> Signs: ...
