# Names that other packages use, each with the module that has it.
from .model_space import ModelSpace as ModelSpace
from .model_space import read_model_space as read_model_space
from .names import ELEVATION_PROPERTY as ELEVATION_PROPERTY
from .names import UNKNOWN as UNKNOWN
