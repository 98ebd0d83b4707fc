# Names that other packages use, each with the module that has it.
from .ortho import Ortho as Ortho
from .presentation import PAGE_SUFFIXES as PAGE_SUFFIXES
from .presentation import PREVIEW_SUFFIXES as PREVIEW_SUFFIXES
from .presentation import Preview as Preview
from .presentation import preview as preview
from .tileset import TilesetPreview as TilesetPreview
from .tileset import is_tileset as is_tileset
from .tileset import preview_tileset as preview_tileset
