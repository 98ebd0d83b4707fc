"""The algorithms, in the order of their use."""

from __future__ import annotations

from .build import BuildAlgorithm
from .check import CheckAlgorithm
from .contours import ContoursAlgorithm
from .convert import ConvertAlgorithm
from .drape import DrapeAlgorithm, InterpolateAlgorithm
from .flow import FlowAlgorithm
from .grade import CorridorAlgorithm, GradeAlgorithm, HydroflattenAlgorithm, RiverbedAlgorithm
from .ground import GroundAlgorithm
from .inspect import InspectAlgorithm
from .install import InstallAlgorithm
from .paste import ClipAlgorithm, CoregisterAlgorithm, MergeAlgorithm, PasteAlgorithm
from .profile import PlanAlgorithm, ProfileAlgorithm
from .raster import RasterAlgorithm
from .refine import RefineAlgorithm, SimplifyAlgorithm
from .sections import SectionsAlgorithm, StakeoutAlgorithm
from .sight import SightAlgorithm
from .slope import SlopeAlgorithm
from .volume import DifferenceAlgorithm, StorageAlgorithm, VolumeAlgorithm

__all__ = ["ALGORITHMS"]

ALGORITHMS = (
    InspectAlgorithm,
    GroundAlgorithm,
    BuildAlgorithm,
    ContoursAlgorithm,
    SlopeAlgorithm,
    ProfileAlgorithm,
    DrapeAlgorithm,
    InterpolateAlgorithm,
    VolumeAlgorithm,
    DifferenceAlgorithm,
    SectionsAlgorithm,
    StakeoutAlgorithm,
    StorageAlgorithm,
    FlowAlgorithm,
    SightAlgorithm,
    GradeAlgorithm,
    CorridorAlgorithm,
    RiverbedAlgorithm,
    HydroflattenAlgorithm,
    PasteAlgorithm,
    MergeAlgorithm,
    ClipAlgorithm,
    CoregisterAlgorithm,
    PlanAlgorithm,
    RasterAlgorithm,
    RefineAlgorithm,
    SimplifyAlgorithm,
    CheckAlgorithm,
    ConvertAlgorithm,
    InstallAlgorithm,
)
