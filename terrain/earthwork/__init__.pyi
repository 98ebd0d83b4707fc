# Names that other packages use, each with the module that has it.
from .clipping import clip as clip
from .differences import Difference as Difference
from .differences import difference as difference
from .error_models import ErrorModel as ErrorModel
from .planes import Plane as Plane
from .planes import as_plane as as_plane
from .planes import level_surface as level_surface
from .regions import as_regions as as_regions
from .storage import stage_storage as stage_storage
from .volumes import as_table as as_table
from .volumes import describe_overlaps as describe_overlaps
from .volumes import subtract as subtract
from .volumes import volume as volume
