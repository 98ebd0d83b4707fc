"""Points, lines and edits to be timed, all made by seeded generators."""
