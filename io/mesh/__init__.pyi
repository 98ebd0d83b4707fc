# Names that other packages use, each with the module that has it.
from .common import FileReference as FileReference
from .common import add_notes as add_notes
from .common import cut_into_fans as cut_into_fans
from .common import join_places as join_places
from .common import make_tin as make_tin
from .common import read_content as read_content
from .common import require_own_crs as require_own_crs
from .common import require_tin as require_tin
from .common import require_writable as require_writable
from .globe import describe_heights as describe_heights
from .globe import has_heights as has_heights
from .globe import place_on_globe as place_on_globe
from .linework import list_chains as list_chains
from .text_rows import format_rows as format_rows
