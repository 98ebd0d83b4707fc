import enum

import numpy as np
from numpy.typing import NDArray

SMALLEST_COORDINATE: float
MOST_POINTS: int
LARGEST_COORDINATE: float

class Method(enum.Enum):
    AUTOMATIC = 0
    GROWTH = 1
    INSERTION = 2

def vector_paths() -> list[str]: ...
def clean(points: NDArray[np.float64], threads: int = ...) -> tuple[NDArray[np.float64], bool]: ...
def grow(
    points: NDArray[np.float64], method: Method = ..., threads: int = ..., path: str = ...
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32] | None, int]: ...
def count_work(
    points: NDArray[np.float64], method: Method = ..., threads: int = ..., path: str = ...
) -> dict[str, int]: ...
def snap(points: NDArray[np.float64], distance: float) -> NDArray[np.int32]: ...
def orientation(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]
) -> NDArray[np.int8]: ...
def compare_distances(
    v: NDArray[np.float64], p: NDArray[np.float64], q: NDArray[np.float64]
) -> NDArray[np.int8]: ...
def in_circle(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    c: NDArray[np.float64],
    d: NDArray[np.float64],
) -> NDArray[np.int8]: ...

class Locator:
    def __init__(
        self,
        points: NDArray[np.float64],
        triangles: NDArray[np.int32],
        neighbors: NDArray[np.int32],
    ) -> None: ...
    def locate(self, xy: NDArray[np.float64]) -> NDArray[np.int32]: ...
    def interpolate(self, xy: NDArray[np.float64]) -> NDArray[np.float64]: ...
    def trace(
        self, starts: NDArray[np.float64], ends: NDArray[np.float64]
    ) -> tuple[
        NDArray[np.int64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.int32],
        NDArray[np.int32],
        NDArray[np.int32],
        NDArray[np.int32],
        int,
    ]: ...

class Mesh:
    def __init__(
        self,
        points: NDArray[np.float64],
        triangles: NDArray[np.int32],
        neighbors: NDArray[np.int32],
        fixed: NDArray[np.bool_] | None = None,
    ) -> None: ...
    @property
    def slots(self) -> int: ...
    @property
    def count(self) -> int: ...
    def alive(self) -> NDArray[np.bool_]: ...
    def has_fixed_edge(self, vertex: int) -> bool: ...
    def insert(self, xy: NDArray[np.float64]) -> NDArray[np.int32]: ...
    def put(self, slot: int, x: float, y: float) -> int: ...
    def remove(self, vertices: NDArray[np.int32]) -> bool: ...
    def force(self, segments: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.int32]]: ...
    def crossed(self, segments: NDArray[np.int32], only_fixed: bool = ...) -> NDArray[np.int32]: ...
    def fixed_neighbors(self, vertex: int) -> NDArray[np.int32]: ...
    def clearance(self, vertex: int) -> float: ...
    def corners_beside(self, a: int, b: int) -> NDArray[np.int32]: ...
    def illegal_fixed_edges(self) -> NDArray[np.int32]: ...
    @property
    def fixed_splits(self) -> int: ...
    def release(self, segments: NDArray[np.int32]) -> int: ...
    def arrays(
        self, threads: int = ...
    ) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.bool_]]: ...

def refine(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    fixed: NDArray[np.bool_],
    kept_whole: NDArray[np.int32],
    least_angle: float,
    largest_area: float,
    longest_edge: float,
    most: int,
) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int32], int, bool]: ...
def regions(
    xy: NDArray[np.float64],
    triangles: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    barrier: NDArray[np.bool_],
) -> tuple[NDArray[np.int32], NDArray[np.int32]]: ...
def crossings(
    xy: NDArray[np.float64],
    segments: NDArray[np.int32],
    first_new: int = ...,
    threads: int = ...,
) -> NDArray[np.int32]: ...
def touches(
    xy: NDArray[np.float64],
    segments: NDArray[np.int32],
    distance: float = ...,
    first_vertex: int = ...,
    is_rounded: bool = ...,
    threads: int = ...,
) -> NDArray[np.int32]: ...
def contacts(
    xy: NDArray[np.float64],
    segments: NDArray[np.int32],
    distance: float = ...,
    threads: int = ...,
) -> tuple[NDArray[np.int32], NDArray[np.int32]]: ...
def intersections(
    xy: NDArray[np.float64], segments: NDArray[np.int32], pairs: NDArray[np.int32]
) -> NDArray[np.float64]: ...
def vertices_at(xy: NDArray[np.float64], queries: NDArray[np.float64]) -> NDArray[np.int32]: ...
def points_in_polygons(
    xy: NDArray[np.float64],
    ring_xy: NDArray[np.float64],
    offsets: NDArray[np.int32],
    threads: int = ...,
) -> NDArray[np.int8]: ...
