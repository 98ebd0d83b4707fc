"""From checked inputs to a triangulated surface: rows merged, lines forced, parts cut away."""
