"""What callers give, checked at the door: options, tables of coordinates, points."""
