# Names that other packages use, each with the module that has it.
from .checker import CheckResult as CheckResult
from .checker import check as check
from .overlaps import describe_oddities as describe_oddities
from .overlaps import find_overlap as find_overlap
