"""Rivers: beds between surveyed cross sections, and water surfaces that fall downstream."""

from .beds import riverbed
from .flattening import hydroflatten

__all__ = ["hydroflatten", "riverbed"]
