"""What attributes of strings tell of lines, in archives that were written here."""

KIND = "line_kind"
"""What the line is, where that is no hard breakline."""

CONSTRAINED = "constrained"
"""Of lines along constrained edges that are no lines of the TIN."""

SOURCE = "line_source"
"""The line that it comes from, counted as in a TIN."""

POLYGON = "line_polygon"
"""What the rings of one polygon share."""

PRIORITY = "line_priority"
