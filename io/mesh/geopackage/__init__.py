"""A whole TIN as a GeoPackage: layers that any GIS opens, and a record of all that is known."""

from .reading import read
from .writing import write

__all__ = ["read", "write"]
