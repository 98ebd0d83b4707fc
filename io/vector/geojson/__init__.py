"""GeoJSON (RFC 7946): the parts of a surface as features."""

from .joining import join_at_antimeridian

__all__ = ["join_at_antimeridian"]
