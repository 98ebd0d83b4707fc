"""GeoJSON (RFC 7946): the parts of a surface as features."""
