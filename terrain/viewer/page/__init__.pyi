# Names that other packages use, each with the module that has it.
from .content import Start as Start
from .content import describe_page as describe_page
from .content import describe_tileset as describe_tileset
from .content import find_labels as find_labels
from .content import make_document as make_document
from .serving import FOLDER as FOLDER
from .serving import serve as serve
