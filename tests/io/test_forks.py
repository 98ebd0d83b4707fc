"""A process forked after files were read and written reads and writes as its parent.

Libraries keep threads, and tinsmith child processes, that a fork has not.
"""

from __future__ import annotations

import os
import sys

import pytest
from support.processes import run

SCRIPT = """
import os, signal, sys, warnings
from pathlib import Path
import numpy as np
import tinsmith as ts
from tinsmith.io.registry import known_formats

warnings.simplefilter("ignore")
points = np.random.default_rng(4).uniform(0, 600, (500, 3)) + [700_000, 4_000_000, 0]
survey = ts.Survey(points=points, crs="EPSG:32616", elevation_unit="m")
tin = ts.triangulate(survey)
things = {
    "Survey": survey,
    "TIN": tin,
    "Features": ts.contours(tin, 50.0),
    "Raster": ts.rasterize(tin, spacing=1.0),
    "Table": ts.slope_statistics(tin),
}

def write_all(folder):
    folder.mkdir()
    for one in known_formats():
        for kind in set(one.writes) & set(things) if one.write and one.suffixes else ():
            path = folder / f"{one.name}-{kind}{one.suffixes[0]}"
            try:
                ts.write(things[kind], path, format=one.name)
            except ts.TinsmithError as error:
                path.with_suffix(".refused").write_text(str(error).replace(str(folder), ""))
            if path.is_file() and kind == "Survey":
                assert len(ts.read(path, crs=survey.crs).points) == len(points), path

def contents(folder):
    return {one.relative_to(folder): one.read_bytes() for one in folder.rglob("*") if one.is_file()}

write_all(Path("parent"))
child = os.fork()
if child == 0:
    signal.alarm(120)
    write_all(Path("child"))
    os._exit(0)
assert os.waitpid(child, 0)[1] == 0
mine, others = contents(Path("parent")), contents(Path("child"))
assert mine.keys() == others.keys()
differ = [str(name) for name in mine if mine[name] != others[name]]
print(len(mine), *differ)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no forks")
def test_every_format_is_written_by_a_fork_too(tmp_path):
    result = run(sys.executable, "-c", SCRIPT, cwd=tmp_path)
    assert result.returncode == 0, result.stdout + result.stderr
    count, *differ = result.stdout.split()
    assert int(count) > 40
    assert differ == []
