"""Quantized-mesh 1.0: terrain tiles for Cesium and other globes."""

from .grid_tiles import FROM_CORNER, GridTile, LevelTiles, Places, choose_height_step
from .layer import (
    MOST_LEVEL,
    choose_finest,
    choose_first,
    count_edge_levels,
    describe_layer,
    describe_many,
    describe_small,
    encode_file,
    find_file,
    find_tolerance,
    list_bare,
    list_missing,
    measure_area,
    write_bare,
)
from .tile import STEPS, TileName, to_cartesian

__all__ = [
    "FROM_CORNER",
    "MOST_LEVEL",
    "STEPS",
    "GridTile",
    "LevelTiles",
    "Places",
    "TileName",
    "choose_finest",
    "choose_first",
    "choose_height_step",
    "count_edge_levels",
    "describe_layer",
    "describe_many",
    "describe_small",
    "encode_file",
    "find_file",
    "find_tolerance",
    "list_bare",
    "list_missing",
    "measure_area",
    "to_cartesian",
    "write_bare",
]
