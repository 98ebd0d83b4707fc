# Types of the compiled core; what it does is said in terrain/_kernel.py.
import numpy as np
from numpy.typing import NDArray

def trace_contours(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    levels: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int32], NDArray[np.bool_]]: ...
def fill_bands(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    levels: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int32]]: ...
