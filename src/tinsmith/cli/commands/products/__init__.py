"""Commands that derive something of a surface."""
