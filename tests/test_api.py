"""The public names: a snapshot of them, their examples, and what type checkers make of them."""

import inspect
import json
import re
import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from support.api import describe_api, public_members, public_objects
from support.processes import run

import tinsmith as ts

ROOT = Path(__file__).parents[1]
SNAPSHOT = ROOT / "tests" / "api.txt"
RENEW = "if that is meant, renew it: PYTHONPATH=tests python -m support.api > tests/api.txt"


def test_public_names_are_those_of_the_snapshot():
    expected, found = SNAPSHOT.read_text().splitlines(), describe_api()
    gone = [f"- {line}" for line in expected if line not in found]
    new = [f"+ {line}" for line in found if line not in expected]
    assert found == expected, "\n".join(["The public API has changed;", RENEW, *gone, *new])


def test_every_public_name_has_an_example():
    called = {
        name: member
        for owner, thing in public_objects()
        for name, member in [(owner, thing), *public_members(owner, thing)]
        if inspect.isfunction(member) or (inspect.isclass(member) and not is_error(member))
    }
    without = {name for name, thing in called.items() if ">>>" not in (thing.__doc__ or "")}
    assert without == set(), "public names whose docstring has no example"


def is_error(thing):
    return issubclass(thing, BaseException)


def test_packages_and_flat_names_are_the_same_things():
    for package in (ts.tin, ts.io, ts.terrain):
        for name in package.__all__:
            if package is ts.terrain and (name == "hillshade" or name.startswith("rasterize")):
                continue  # those of all read the file of ``like``, too
            if name not in ("LengthUnit", "field_codes"):  # what Unit was, and where a module was
                assert getattr(ts, name) is getattr(package, name), name
    assert ts.voronoi is ts.tin.voronoi.voronoi


@pytest.mark.parametrize(
    "name", ["", ".tin", ".io", ".terrain", ".io.isolated", ".io.field_survey"]
)
def test_every_name_of_a_stub_is_there(name):
    """A stub is the one list of a package's names, for type checkers and for use."""
    package = import_module(f"tinsmith{name}")
    text = Path(package.__file__).with_suffix(".pyi").read_text()
    allowed = r"from \S+ import (?:(\w+) as \1|\*  # noqa: F403)|#.*|__version__: str|"
    assert [line for line in text.splitlines() if not re.fullmatch(allowed, line)] == []
    named = set(re.findall(r" as (\w+)$", text, re.M))
    assert named <= set(package.__all__) <= set(dir(package)) | {"__version__"}
    assert all(getattr(package, one) is not None for one in package.__all__)


HEAVY = "pandas pyarrow rasterio pyogrio pyproj pyvista vtk shapely matplotlib meshio rich"
BEGIN_WITH = f"""
import os, sys, numpy, tinsmith
for name in sys.argv[1:]:
    child = os.fork()
    if child == 0:
        getattr(tinsmith, name)
        print(name, *sorted(set("{HEAVY}".split()) & set(sys.modules)), flush=True)
        os._exit(0)
    os.waitpid(child, 0)
"""


@pytest.mark.slow
def test_every_name_can_be_the_first():
    """No circle of imports shows up, whichever name a program begins with; nothing heavy comes."""
    names = [name for name in ts.__all__ if name != "__version__"]
    result = run(sys.executable, "-c", BEGIN_WITH, *names)
    assert result.stdout.splitlines() == names, result.stderr


def test_import_alone_loads_not_even_numpy():
    code = "import sys, tinsmith; print('numpy' in sys.modules, 'tinsmith.tin' in sys.modules)"
    assert run(sys.executable, "-c", code).stdout.split() == ["False", "False"]


# -------------------------------------------------------------------- type checkers

MYPY = """
[mypy]
strict = True
[mypy-tinsmith.*]
# As of what is installed: signatures count, not what is in functions.
ignore_errors = True
[mypy-shapely.*,rasterio.*,pyogrio.*,pyvista.*,vtk.*,vtkmodules.*,matplotlib.*,meshio.*]
ignore_missing_imports = True
"""
PYRIGHT = {
    "extraPaths": ["installed"],
    "typeCheckingMode": "strict",
    "pythonVersion": "3.11",
}
TYPOS = """
import tinsmith as ts

tin = ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
tin.trianlges
ts.trianglate(tin)
ts.io.raed("a.csv")
tin.triangles = tin.triangles
ts.slope(tin).mx()
ts.voronoi(tin, bounday=None)
ts.TIN.closest_vertex(tin)
ts.read_points("a.csv").pionts
ts.read_tin("a.ply").trianlges
tin.interpolate(1.0, 2.0).trianlges
reveal_type(ts.slope)
reveal_type(tin.closest_vertex([[0, 0]]))
"""
FLAT = """
import tinsmith as ts

tin = ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
print(ts.terrain.slope(tin), ts.tin.refine(tin), ts.io.read("a.ply"), tin.voronoi(pad=1).areas)
print(ts.quality(tin).min_angle, ts.check(tin).ok, ts.lift(tin), ts.read("a.ply").triangles)
print(tin.is_edge(0, 1), tin.vertex_triangles(0), tin.triangle_normals.sum(), ts.paper)
crs: ts.CRS = ts.CRS("EPSG:32616")
line: ts.Breakline = ts.Breakline([[0, 0, 1], [1, 1, 1]])
"""


@pytest.fixture(scope="module")
def users_folder(tmp_path_factory):
    """Mount the packages as they are installed, beside the place of a user's program."""
    folder = tmp_path_factory.mktemp("users")
    package = folder / "installed" / "tinsmith"
    package.mkdir(parents=True)
    for source in (ROOT / "src" / "tinsmith").iterdir():
        if source.name != "__pycache__":
            (package / source.name).symlink_to(source)
    for name in ("tin", "io", "terrain"):
        (package / name).symlink_to(ROOT / name)
    (folder / "mypy.ini").write_text(MYPY)
    return folder


def run_mypy(folder, files):
    # In the repository's root mypy would take its folder "io" for Python's own.
    options = ["--config-file", "mypy.ini", "--cache-dir", "cache", *files]
    command = [str(Path(sys.executable).parent / "mypy"), *options]
    return run(*command, cwd=folder, MYPYPATH="installed").stdout


def run_pyright(folder, files):
    """Run the pyright whose wheel brings all that it needs."""
    (folder / "pyrightconfig.json").write_text(json.dumps({"include": files, **PYRIGHT}))
    return run(
        *(sys.executable, "-m", "basedpyright", "--pythonpath", sys.executable), cwd=folder
    ).stdout


@pytest.mark.every_case("slow")
@pytest.mark.slow
@pytest.mark.parametrize("run_checker", [run_mypy, run_pyright])
def test_type_checkers_take_users_programs_and_refuse_names_that_are_not_there(
    run_checker, users_folder
):
    """In one run, strictly: the README, flat names and those of packages, and typos."""
    readme = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    programs = {"readme.py": "\n".join(readme), "flat.py": FLAT, "typos.py": TYPOS}
    for name, text in programs.items():
        (users_folder / name).write_text(text)
    found = run_checker(users_folder, list(programs))
    lines = re.findall(r"(\w+\.py):(\d+):(?:\d+ -)? error", found)
    wrong = {name: sorted({int(line) for one, line in lines if one == name}) for name in programs}
    assert wrong == {"readme.py": [], "flat.py": [], "typos.py": [*range(5, 15)]}, found
    notes = dict(re.findall(r"typos.py:(\d+):.*(?:note|information): (.*)", found))
    assert "TIN, *, unit: " in notes["15"], found
    assert "int" in notes["16"], found


# -------------------------------------------------------------------- values of a wrong type

FLAT_TIN = ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]])


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: ts.read(5), "Invalid path 5: it must be the name of a file"),
        (lambda: ts.write(FLAT_TIN, b"a.ply"), "Invalid path b'a.ply'"),
        (lambda: ts.read_lines(None), "Invalid path None"),
        (lambda: ts.read_water({}), "Invalid path {}"),
        (lambda: ts.preview(FLAT_TIN, output=5), "Invalid output 5"),
        (lambda: ts.preview(FLAT_TIN, output="a.png", size=5), "Invalid size 5"),
        (lambda: ts.with_lines(5), "Invalid survey 5: it must be a Survey"),
        (lambda: ts.with_lines(ts.Survey(points=[[0, 0, 0]]), breaklines="a.gpkg"), "a list"),
        (lambda: ts.find_format("ply", "open"), "Invalid action 'open'"),
        (lambda: ts.difference(FLAT_TIN, 5), "Invalid TIN 5"),
        (lambda: ts.stage_storage([1], interval=1), "Invalid TIN [1]"),
        (lambda: ts.stage_storage(FLAT_TIN, interval=10**400), "Invalid interval"),
        (lambda: ts.curvature(None), "Invalid TIN None"),
        (lambda: ts.contours(FLAT_TIN, levels=[10**400]), "Invalid levels"),
        (lambda: ts.stage_storage(FLAT_TIN, levels=[10**400]), "Invalid levels"),
        (lambda: ts.volume(FLAT_TIN, base=10**400), "Invalid base"),
        (lambda: ts.Features(kind="points", coordinates=[[10**400, 0]]), "Invalid coordinates"),
        (lambda: ts.Survey(points=np.array(1.5)), "Points have shape ()"),
        (lambda: ts.profile(np.array(1.5), [[0, 0], [1, 1]]), "Invalid TIN"),
        (lambda: FLAT_TIN.plot(lines=np.arange(2)), "Invalid lines"),
        (lambda: FLAT_TIN.plot(colorbar=np.arange(2)), "Invalid colorbar"),
        (lambda: ts.tiles("a.las", where=np.arange(2)), "Invalid where"),
        (lambda: ts.read("\ud800.csv"), "encoding of file names"),
        (lambda: ts.hillshade("a"), "Invalid TIN 'a'"),
        (lambda: ts.Features(kind="points", coordinates=[[0, 0, 0]], notes=5), "Invalid notes 5"),
        (lambda: ts.Features(kind=[1], coordinates=[[0, 0, 0]]), "Invalid kind [1]"),
        (lambda: ts.CRS({"a": [[0, 0], [0, 0]]}), "Unknown CRS {'a': [[0, 0], [0, 0]]}"),
    ],
)
def test_values_of_a_wrong_type_are_refused_in_a_sentence(call, words):
    with pytest.raises(ts.TinsmithError) as caught:
        call()
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
