"""Modules are plain modules, so that whatever sends functions to other processes takes them."""

import importlib
import pickle
import pkgutil
import subprocess
import sys
from types import ModuleType

import cloudpickle
import numpy as np
import pytest
from support.each_value import list_seeds

import tinsmith as ts

PACKAGES = ["tinsmith", "tinsmith.tin", "tinsmith.io", "tinsmith.terrain"]

USE_ALL = """
import importlib, pkgutil, random, sys, types
import tinsmith
names = list(tinsmith.__all__)
modules = [one.name for one in pkgutil.walk_packages(tinsmith.__path__, "tinsmith.")
           if not one.name.endswith("__main__")]
steps = [*names, *modules]
random.Random({seed}).shuffle(steps)
for step in steps:
    if "." not in step:
        getattr(tinsmith, step)
        continue
    try:
        importlib.import_module(step)
    except Exception:  # children import libraries of their own
        pass
odd = [name for name, one in sys.modules.items()
       if name.startswith("tinsmith") and type(one) is not types.ModuleType]
assert not odd, odd
hidden = [name for name in names if isinstance(getattr(tinsmith, name), types.ModuleType)]
assert hidden == ["io", "paper", "terrain", "tin"], hidden
assert not isinstance(tinsmith.terrain.preview, types.ModuleType)
"""


@pytest.mark.parametrize("seed", list_seeds(3, few=1))
def test_all_modules_are_plain_and_hide_no_name_in_any_order(seed):
    done = subprocess.run(
        [sys.executable, "-c", USE_ALL.format(seed=seed)], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("package", PACKAGES)
def test_no_public_name_is_that_of_a_module(package):
    """Python binds a module to its package as soon as it is loaded, whatever has the name."""
    found = importlib.import_module(package)
    modules = {one.name for one in pkgutil.iter_modules(found.__path__)}
    both = modules & set(found.__all__)
    assert all(isinstance(getattr(found, name), ModuleType) for name in both)


def measure(seed):
    points = np.random.default_rng(seed).random((100, 3))
    return ts.triangulate(points).area


def test_functions_that_use_the_package_are_sent_by_value():
    function = cloudpickle.loads(cloudpickle.dumps(lambda seed: measure(seed)))
    assert function(1) == measure(1)
    for module in (ts, ts.terrain, ts.io, ts.tin):
        assert pickle.loads(cloudpickle.dumps(module)) is module


def test_a_function_of_a_script_reaches_another_process(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "import cloudpickle, pathlib\n"
        "import tinsmith as ts\n"
        "def area(points):\n    return ts.volume(ts.triangulate(points), base=0.0)['fill'][0]\n"
        "pathlib.Path('function').write_bytes(cloudpickle.dumps(area))\n"
    )
    subprocess.run([sys.executable, script], check=True, cwd=tmp_path)
    read = "import pickle, sys; print(pickle.load(open('function', 'rb'))(P))"
    points = "P = [[0.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 1.0, -1.0]]; "
    done = subprocess.run(
        [sys.executable, "-c", points + read], check=True, cwd=tmp_path, capture_output=True
    )
    assert float(done.stdout) == pytest.approx(0.5)
