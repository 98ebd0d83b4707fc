# Names that other packages use, each with the module that has it.
from .gradients import aspect as aspect
from .gradients import slope as slope
from .statistics import PERCENTILES as PERCENTILES
from .statistics import as_table as as_table
from .statistics import list_terms as list_terms
from .statistics import merge_terms as merge_terms
from .statistics import name_percentiles as name_percentiles
from .statistics import select_weighted_percentiles as select_weighted_percentiles
from .statistics import summarise as summarise
