"""The world room: readers, writers and the format registry."""
