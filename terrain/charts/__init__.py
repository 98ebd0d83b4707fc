"""Charts: distributions and comparisons as flat pictures."""
