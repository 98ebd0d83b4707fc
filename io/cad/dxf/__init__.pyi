# Names that other packages use, each with the module that has it.
from .layers import ELEVATION_PROPERTY as ELEVATION_PROPERTY
from .layers import UNKNOWN as UNKNOWN
from .model_space import ModelSpace as ModelSpace
from .model_space import read_model_space as read_model_space
