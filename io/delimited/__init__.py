"""Survey points as delimited text: its layout found, its rows checked and parsed."""
