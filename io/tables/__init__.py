"""Tables of results as CSV and JSON."""
