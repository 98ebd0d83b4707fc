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
def trace_contours(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    levels: NDArray[np.float64],
) -> tuple[
    NDArray[np.float64],
    NDArray[np.int64],
    NDArray[np.int32],
    NDArray[np.bool_],
    NDArray[np.float64],
]: ...
def fill_bands(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    levels: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int32]]: ...
def smooth_contours(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    levels: NDArray[np.float64],
    xyz: NDArray[np.float64],
    offsets: NDArray[np.int64],
    level: NDArray[np.int32],
    is_closed: NDArray[np.bool_],
    places: NDArray[np.int32],
    smooth: float,
    rounds: int,
    simplify: float,
) -> tuple[
    NDArray[np.float64],
    NDArray[np.int64],
    NDArray[np.int32],
    NDArray[np.bool_],
    NDArray[np.float64],
]: ...
def sum_between(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    groups: NDArray[np.int32],
    group_count: int,
    other_points: NDArray[np.float64],
    other_triangles: NDArray[np.int32],
    up: float,
    threads: int = ...,
) -> NDArray[np.float64]: ...
def sum_heights(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    heights: NDArray[np.float64],
    groups: NDArray[np.int32],
    group_count: int,
    up: float,
) -> NDArray[np.float64]: ...
def sum_areas(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    groups: NDArray[np.int32],
    group_count: int,
) -> NDArray[np.float64]: ...
def overlay(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    other_points: NDArray[np.float64],
    other_triangles: NDArray[np.int32],
) -> tuple[
    NDArray[np.float64],
    NDArray[np.int32],
    NDArray[np.int64],
    NDArray[np.int32],
    NDArray[np.int32],
]: ...
def stage_sums(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    levels: NDArray[np.float64],
    up: float,
) -> NDArray[np.float64]: ...
