"""Types of the compiled core."""

import numpy as np
from numpy.typing import NDArray

SMALLEST_COORDINATE: float
LARGEST_COORDINATE: float

def grow(
    points: NDArray[np.float64],
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32] | None, int]: ...
def count_work(points: NDArray[np.float64]) -> dict[str, int]: ...
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
