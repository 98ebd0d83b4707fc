# Names that other packages use, each with the module that has it.
from .area_of_use import AreaOfUse as AreaOfUse
from .elevation_summary import ElevationSummary as ElevationSummary
from .gaps import describe_gaps as describe_gaps
from .naming import find_number as find_number
from .nodata import describe_elevations as describe_elevations
from .nodata import describe_suspects as describe_suspects
from .nodata import find_suspect_elevations as find_suspect_elevations
from .nodata import parse_nodata as parse_nodata
from .notes import describe_findings as describe_findings
from .notes import describe_screening as describe_screening
from .searching import Screening as Screening
from .searching import inspect_points as inspect_points
from .searching import screen_points as screen_points
from .suspects import DROPPED as DROPPED
from .suspects import Suspect as Suspect
