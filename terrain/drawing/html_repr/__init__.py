"""HTML representations: what a notebook shows of surveys, reports and results."""
