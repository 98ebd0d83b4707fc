"""X3D for tinsmith: a format that is written, and a command that looks into such a file."""
