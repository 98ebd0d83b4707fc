"""A disk that is full as GDAL closes a file: refused, whatever the format."""

from __future__ import annotations

import sys

import pytest
from support.processes import run

SHARES = (0.5, 0.9, 0.9999)
CODE = """
import os, resource, signal, sys, warnings
import numpy as np
import tinsmith as ts

warnings.simplefilter("ignore")
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
random = np.random.default_rng(0)
name, form, folder, *shares = sys.argv[1:]
if name.endswith(".tif"):
    grid = ts.Grid(ts.Bounds(0, 0, 600, 700), (700, 600), 1.0)
    made = ts.Raster({"z": random.uniform(size=(700, 600))}, grid)
else:
    xyz = random.uniform(0, 1000, (3000, 3))
    made = ts.Features.of_points(xyz, columns={"a": random.uniform(size=3000)})
options = {} if form == "-" else {"format": form}
path = ts.write(made, f"{folder}/{name}", **options)
size = path.stat().st_size
path.unlink()
_, most = resource.getrlimit(resource.RLIMIT_FSIZE)
for share in shares:
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(size * float(share)), most))
    try:
        ts.write(made, path, **options)
    except ts.WriteError as error:
        print(share, os.listdir(folder), error)
"""


@pytest.mark.parametrize(("name", "form"), [("a.fgb", "-"), ("a.tif", "cog"), ("a.tif", "geotiff")])
def test_a_file_without_its_end_is_refused(tmp_path, name, form):
    shares = [str(share) for share in SHARES]
    result = run(sys.executable, "-c", CODE, name, form, str(tmp_path), *shares, cwd=tmp_path)
    told = result.stdout.splitlines()
    assert len(told) == len(SHARES), result.stdout + result.stderr
    for share, line in zip(shares, told, strict=True):
        assert line.startswith(f"{share} [] Cannot write"), line
