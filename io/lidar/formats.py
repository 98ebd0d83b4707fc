"""The formats of lidar."""

from ..registry.format import SURFACES, Format
from .signatures import is_lidar

__all__ = ["FORMATS"]

FORMATS = (
    Format(
        name="las",
        description="Lidar: LAS 1.0 to 1.4, LAZ and COPC",
        suffixes=(".las", ".laz"),
        read="tinsmith.io.lidar.reading:read",
        write="tinsmith.io.lidar.writing:write",
        writes=SURFACES,
        precision=(
            "Whole multiples of the scale, a power of ten: the coarsest that gives every "
            "coordinate back, else a millionth of a CRS unit, or what 32 bits hold."
        ),
        losses="Of a TIN all but its vertices; texts among the attributes of a survey.",
        extra="lidar",
        sniff=is_lidar,
    ),
)
