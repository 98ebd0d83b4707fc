# Names that other packages of `io` use, each with the module that has it.
from .chunks import Blocks as Blocks
from .chunks import Counts as Counts
from .chunks import NothingLeftError as NothingLeftError
from .chunks import PointChunk as PointChunk
from .chunks import SourceHeader as SourceHeader
from .chunks import StreamEnd as StreamEnd
from .chunks import StreamHead as StreamHead
from .chunks import gather as gather
from .chunks import gathering as gathering
from .chunks import join_chunks as join_chunks
from .chunks import make_source_header as make_source_header
from .chunks import yield_survey as yield_survey
from .format import SURFACES as SURFACES
from .format import Format as Format
from .lookup import find_writer as find_writer
from .lookup import list_writers as list_writers
