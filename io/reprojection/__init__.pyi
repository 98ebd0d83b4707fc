# Names that other packages of `io` use, each with the module that has it.
from .contradictions import are_small_degrees as are_small_degrees
from .contradictions import checking_crs as checking_crs
from .placement import Placing as Placing
from .placement import place as place
from .placement import settle_unit as settle_unit
from .placement import stays as stays
from .transformation import find_bounds as find_bounds
from .transformation import find_conversion_factor as find_conversion_factor
from .transformation import is_geographic as is_geographic
