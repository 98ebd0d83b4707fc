"""Timings beside the peers, one core each; every answer that is timed is compared first."""

import os

# SciPy inverts one small matrix a triangle; threads that wait for each other make that 50 times
# slower, and it would not be one core against one core.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
