"""The meaning room: what a terrain surface says. Knows no files."""
