"""Quantized-mesh 1.0: terrain tiles for Cesium and other globes."""

from .tile import to_cartesian

__all__ = ["to_cartesian"]
