"""Records: all that a TIN is, as values that JSON holds and arrays, and the TIN of them again."""

from .packing import Record, pack_tin
from .unpacking import unpack_tin

__all__ = ["Record", "pack_tin", "unpack_tin"]
