"""What was measured, as a page, a plot and how it stands to the goals."""
