"""Lines that the surface must hold: given, noded, draped, and what they cut away."""
