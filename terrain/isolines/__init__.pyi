# Names that other packages use, each with the module that has it.
from .bands import as_band_features as as_band_features
from .bands import contour_bands as contour_bands
from .checking import ContourCheck as ContourCheck
from .checking import check_contours as check_contours
from .labels import contour_labels as contour_labels
from .labels import count_decimals as count_decimals
from .levels import LevelOptions as LevelOptions
from .levels import Levels as Levels
from .levels import as_levels as as_levels
from .levels import elevation_range as elevation_range
from .lines import as_features as as_features
from .lines import contours as contours
from .rebuilding import measure_off as measure_off
