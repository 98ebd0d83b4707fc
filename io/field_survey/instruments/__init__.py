"""Files of survey instruments: points by coordinates, or reduced from angles and distances."""
