"""What callers give, checked on entry: options, tables of coordinates, points."""
