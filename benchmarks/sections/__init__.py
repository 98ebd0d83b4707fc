"""What is timed: one module for each section of the report."""
