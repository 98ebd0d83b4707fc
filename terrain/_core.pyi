# Types of the compiled core; what it does is said in terrain/_kernel.py.
import numpy as np
from numpy.typing import NDArray

def values_at_centers(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    spacing: float,
    values: NDArray[np.float64] | None,
    threads: int = ...,
) -> NDArray[np.float64]: ...
def means_of_cells(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    spacing: float,
    x_edges: NDArray[np.float64],
    y_edges: NDArray[np.float64],
    values: NDArray[np.float64] | None,
    threads: int = ...,
) -> NDArray[np.float64]: ...
