"""What every package stands on: errors, checks, CRS and units, notes, results, types."""
