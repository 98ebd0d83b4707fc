# Names that other packages use, each with the module that has it.
from .alignment_reading import read_alignment as read_alignment
from .reading import read as read
