"""The paper's algorithms of growth, exactly as written: for reference and comparison."""

from .comparison import Comparison, Outcome, compare
from .growth import Distance, EmptyCircle, Network, improved, original

__all__ = [
    "Comparison",
    "Distance",
    "EmptyCircle",
    "Network",
    "Outcome",
    "compare",
    "improved",
    "original",
]
