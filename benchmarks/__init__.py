"""Timings beside the peers, one core each; every answer that is timed is compared first."""

import os

# SciPy inverts one small matrix a triangle; threads that wait for each other make that 50 times
# slower, and it would not be one core against one core. The same for pandas' and polars' pools.
for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "GDAL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
