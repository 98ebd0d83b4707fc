# Names that other packages use, each with the module that has it.
from .comparison import MOST_POINTS as MOST_POINTS
from .comparison import Comparison as Comparison
from .comparison import Outcome as Outcome
from .comparison import compare as compare
from .growth import Distance as Distance
from .growth import EmptyCircle as EmptyCircle
from .growth import Network as Network
from .growth import improved as improved
from .growth import original as original
