import enum

import numpy as np
from numpy.typing import NDArray

SMALLEST_COORDINATE: float
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
def vertices_at(xy: NDArray[np.float64], places: NDArray[np.float64]) -> NDArray[np.int32]: ...
def places_in_rings(
    xy: NDArray[np.float64],
    ring_xy: NDArray[np.float64],
    offsets: NDArray[np.int32],
    threads: int = ...,
) -> NDArray[np.int8]: ...
