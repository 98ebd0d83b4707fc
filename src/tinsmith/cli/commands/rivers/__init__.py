"""Commands of rivers: their beds, and the water in them."""
