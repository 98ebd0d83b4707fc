"""The algorithms, in the order of their use."""

from __future__ import annotations

from .build import BuildAlgorithm
from .check import CheckAlgorithm
from .contours import ContoursAlgorithm
from .convert import ConvertAlgorithm
from .install import InstallAlgorithm
from .profile import ProfileAlgorithm
from .raster import RasterAlgorithm
from .refine import RefineAlgorithm
from .simplify import SimplifyAlgorithm
from .slope import SlopeAlgorithm
from .volume import StorageAlgorithm, VolumeAlgorithm

__all__ = ["ALGORITHMS"]

ALGORITHMS = (
    BuildAlgorithm,
    ContoursAlgorithm,
    SlopeAlgorithm,
    ProfileAlgorithm,
    VolumeAlgorithm,
    StorageAlgorithm,
    RasterAlgorithm,
    RefineAlgorithm,
    SimplifyAlgorithm,
    CheckAlgorithm,
    ConvertAlgorithm,
    InstallAlgorithm,
)
