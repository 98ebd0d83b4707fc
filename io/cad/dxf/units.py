"""Units as the header of a drawing names them, ``$INSUNITS``."""

from __future__ import annotations

from ....base.crs import FOOT, METRE, US_SURVEY_FOOT, Unit

__all__ = ["UNIT_OF_CODE", "find_code"]

UNIT_OF_CODE = {
    1: Unit.of("in"),
    2: FOOT,
    3: Unit("Statute mile", "mi", 1609.344),
    4: Unit.of("mm"),
    5: Unit.of("cm"),
    6: METRE,
    7: Unit.of("km"),
    10: Unit.of("yd"),
    14: Unit.of("dm"),
    21: US_SURVEY_FOOT,
}
"""Units of lengths that surveys have; 0 stands for none."""


def find_code(unit: Unit | None) -> int:
    """Return the number of a unit, 0 for one that DXF does not have."""
    return next((code for code, one in UNIT_OF_CODE.items() if one == unit), 0)
