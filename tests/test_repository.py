"""The rules of the repository: lint, types, import contract, no circle, light imports."""

import ast
import doctest
import importlib
import linecache
import os
import pkgutil
import re
import sys
from collections import Counter
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path, PurePosixPath

import numpy as np
import pytest
from support import processes
from support.blocks import list_pages, name_page, read_blocks
from support.commands import run_command
from support.lidar_files import make_cloud, write_copc
from support.orthos import write_grey

import tinsmith
import tinsmith as ts
import tinsmith.cli
from benchmarks.structure import measure as measure_structure

# A contract that `make test` does not check would be broken until CI runs.
pytestmark = pytest.mark.every_case

ROOT = Path(__file__).parents[1]


def parse(path):
    """Parse a file; nobody keeps the trees, of which the collector would search a million nodes."""
    return ast.parse(path.read_text())


def list_statements(block):
    """Yield the statements of a block, and those within them."""
    for statement in block:
        yield statement
        for name in ("body", "orelse", "finalbody", "handlers", "cases"):
            yield from list_statements(getattr(statement, name, ()))


def run(*command, cwd=ROOT, **environment):
    return processes.run(*command, cwd=cwd, **environment)


def tool(name):
    return str(Path(sys.executable).parent / name)


@pytest.fixture
def tree(tmp_path):
    """Mount the folders as the one package that they are once installed."""
    package = tmp_path / "tinsmith"
    package.mkdir()
    for source in (ROOT / "src" / "tinsmith").iterdir():
        if source.name != "__pycache__":
            (package / source.name).symlink_to(source)
    for folder in ("tin", "io", "terrain"):
        (package / folder).symlink_to(ROOT / folder)
    return tmp_path


def test_lint_and_formatting():
    for command in (("check", "."), ("format", "--check", ".")):
        result = run(tool("ruff"), *command)
        assert result.returncode == 0, result.stdout + result.stderr


@pytest.mark.slow
def test_types(tree):
    result = run(tool("mypy"), "--config-file", str(ROOT / "pyproject.toml"), cwd=tree)
    assert result.returncode == 0, result.stdout + result.stderr


def test_import_contract(tree):
    result = run(
        tool("lint-imports"),
        "--config",
        str(ROOT / "pyproject.toml"),
        "--no-cache",
        cwd=tree,
        PYTHONPATH=str(tree),
    )
    assert result.returncode == 0, result.stdout + result.stderr


def modules_of(tree):
    """Return every module of the package with its file."""
    found = {}
    for folder, folders, files in os.walk(tree / "tinsmith", followlinks=True):
        folders[:] = [name for name in folders if name not in ("cpp", "__pycache__")]
        for file in files:
            path = Path(folder) / file
            if path.suffix == ".py":
                parts = path.relative_to(tree).with_suffix("").parts
                name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
                found[name] = path
    return found


def imports_of(name, path, modules):
    """Return the modules that one imports, at its head or within functions.

    In tin also for its types: what a module speaks of lies below it. Elsewhere a record may load
    what writes it as something else, and that may name the record's type. Names that a package
    lists in its stub are imported from the module that has them.
    """
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    statements = [*list_statements(parse(path.resolve()).body)]
    typing_only = {
        id(node)
        for block in statements
        if isinstance(block, ast.If) and "TYPE_CHECKING" in ast.unparse(block.test)
        for node in list_statements([block])
        if not name.startswith("tinsmith.tin.")
    }
    for node in statements:
        if isinstance(node, ast.ImportFrom) and node.level and id(node) not in typing_only:
            base = package.split(".")[: len(package.split(".")) - node.level + 1]
            source = ".".join([*base, *([node.module] if node.module else [])])
            for alias in node.names:
                module = f"{source}.{alias.name}"
                if module in modules:
                    yield module
                elif node.module:  # the compiled core is no module of these
                    yield find_in_stubs(source, alias.name, modules)


def find_in_stubs(package, name, modules):
    """Return the module that has a name of a package; itself if it has no stub that says."""
    listed = list_stub(modules[package].with_suffix(".pyi")) if package in modules else {}
    if name not in listed:
        return package
    above = package.split(".")[: len(package.split(".")) - listed[name].level + 1]
    return find_in_stubs(".".join([*above, listed[name].module]), name, modules)


@cache
def list_stub(path):
    """Return the statement that imports each name of a package; none of a module."""
    if path.name != "__init__.pyi" or not path.exists():
        return {}
    statements = [
        one for one in ast.parse(path.read_text()).body if isinstance(one, ast.ImportFrom)
    ]
    return {alias.name: one for one in statements for alias in one.names}


def test_no_modules_know_each_other_in_a_circle(tree):
    modules = modules_of(tree)
    graph = {
        name: {one for one in imports_of(name, path, modules) if one in modules and one != name}
        for name, path in modules.items()
    }
    assert len(graph) > 150
    assert sum(map(len, graph.values())) > 700
    try:
        tuple(TopologicalSorter(graph).static_order())
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


def test_only_the_kernel_modules_import_the_cores():
    users = [
        path.relative_to(ROOT).as_posix()
        for folder in ("tin", "io", "terrain", "src")
        for path in (ROOT / folder).rglob("*.py")
        if "import _core" in path.read_text()
    ]
    assert users == ["tin/_kernel.py", "terrain/_kernel.py"]


def test_packages_are_never_imported_from_the_root():
    code = (
        "import sys, tinsmith as ts; ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]]);"
        "from tinsmith import io, terrain;"
        "assert not {'tin', 'terrain'} & set(sys.modules), 'a second copy of a package'"
    )
    result = run(sys.executable, "-c", code)
    assert result.returncode == 0, result.stderr


def test_import_loads_no_heavy_library():
    heavy = "pandas pyarrow polars rasterio pyproj pyvista shapely rich click"
    code = (
        "import sys, tinsmith; tinsmith.triangulate;"
        f"print(sorted(set({heavy!r}.split()) & set(sys.modules)))"
    )
    result = run(sys.executable, "-c", code)
    assert result.stdout.strip() == "[]", result.stderr


def test_every_public_name_is_there():
    for name in tinsmith.__all__:
        assert getattr(tinsmith, name) is not None


@pytest.mark.slow
def test_public_examples_run():
    """Run the examples of every docstring in every package, but that which draws in 3D."""
    names = ["tinsmith"]
    for package in (tinsmith.tin, tinsmith.io, tinsmith.terrain):
        names += [
            module.name
            for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
        ]
    tried = 0
    for name in names:
        if name.endswith("._core"):
            continue
        result = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
        linecache.clearcache()  # doctest looks at the file of each line in it for each example
        assert result.failed == 0, name
        tried += result.attempted
    assert tried > 0


MOST_ENTRIES = 20
LARGER_FOLDERS = {
    "io/mesh": 27,
    "io/delimited": 24,
    "io/vector": 22,
    "qgis/tinsmith/icons": 32,
}
"""Those with a file for each format or algorithm, and those to be divided: may only shrink."""


def test_folders_can_be_taken_in_at_a_glance():
    entries = {}
    tracked = run(
        "git", "ls-files", "-z", "tin", "io", "terrain", "src", "qgis", "blender", "packaging"
    )
    for path in map(PurePosixPath, tracked.stdout.split("\0")[:-1]):
        for entry, folder in zip((path, *path.parents), path.parents, strict=False):
            entries.setdefault(str(folder), set()).add(entry.name)
    del entries["."]
    for folder, names in entries.items():
        stubs = {name for name in names if name.endswith(".pyi") and name[:-1] in names}
        most = LARGER_FOLDERS.get(folder, MOST_ENTRIES)
        assert len(names - stubs) <= most, f"{folder}: {sorted(names)}"
    for folder, most in LARGER_FOLDERS.items():
        assert MOST_ENTRIES < len(entries[folder] - {"__init__.pyi"}) <= most, folder


MOST_SPLINTERS = 40
"""Private functions called once with more than four positional parameters: may only fall."""
MOST_PAST_A_FACE = 38
"""Imports of a module within another package, not of what that package lists: may only fall."""


@pytest.fixture(scope="module")
def figures():
    return measure_structure(ROOT)


def test_private_functions_called_once_take_few_parameters(figures):
    assert len(figures.splinters) <= MOST_SPLINTERS, figures.splinters


def test_imports_past_the_face_of_a_package_grow_no_more(figures):
    packages = Counter(target.rpartition(".")[0] for _, target in figures.past_a_face)
    assert len(figures.past_a_face) <= MOST_PAST_A_FACE, packages.most_common()


def test_only_packages_list_their_names():
    """A module's public names are those without an underscore at their head."""
    listing = [
        path.relative_to(ROOT).as_posix()
        for folder in ("tin", "io", "terrain", "src")
        for path in (ROOT / folder).rglob("*.py")
        if path.name != "__init__.py" and re.search(r"^__all__\b", path.read_text(), re.MULTILINE)
    ]
    assert listing == []


ROOT_ENTRIES = """
.ci .clang-format .dockerignore .github .gitignore .pre-commit-config.yaml ARCHITECTURE.md
CHANGELOG.md CMakeLists.txt CONTRIBUTING.md LICENSE Makefile README.md SECURITY.md benchmarks
blender constraints.txt docs io packaging pyproject.toml qgis sample_data src terrain tests tin web
"""


def test_the_root_holds_these_entries_and_no_file_of_a_run():
    tracked = run("git", "ls-files", "-z")
    assert tracked.returncode == 0, tracked.stderr
    entries = {path.split("/")[0] for path in tracked.stdout.split("\0")[:-1]}
    assert entries == set(ROOT_ENTRIES.split())


def test_the_architecture_fits_a_minute():
    assert len((ROOT / "ARCHITECTURE.md").read_text().splitlines()) <= 80


MOST_LINES = 60
FOLDERS = (
    "tin",
    "io",
    "terrain",
    "src",
    "qgis",
    "blender",
    "web",
    "tests",
    "benchmarks",
    "sample_data",
)


def measure_python_functions(path):
    """Yield name and lines of every function's body, docstring aside."""
    for node in list_statements(parse(path).body):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            body = node.body[1:] if ast.get_docstring(node, clean=False) is not None else node.body
            yield node.name, body[-1].end_lineno - body[0].lineno + 1 if body else 0


def measure_cpp_functions(path):
    """Yield beginning and lines of every function's body: what is between braces of code.

    As clang-format lays it out: a function's last brace stands under its first letter.
    """
    lines = path.read_text().splitlines()
    for start, line in enumerate(lines):
        head = line.strip()
        if not re.search(r"\)( const| noexcept| override|( ->[^{]*))* \{$", head):
            continue
        if re.match(r"(if|for|while|switch|} else|else|do|catch|} catch)\b", head):
            continue
        first = start
        while lines[first].lstrip().startswith(":") or lines[first - 1].endswith((",", "(")):
            first -= 1
        indent = re.match(" *", lines[first])[0]
        end = next(
            (row for row in range(start + 1, len(lines)) if lines[row].startswith(f"{indent}}}")),
            start,
        )
        yield head, end - start - 1


def test_functions_are_short():
    measure = {".py": measure_python_functions, ".hpp": measure_cpp_functions}
    measure[".cpp"] = measure_cpp_functions
    found = {".py": [], ".hpp": [], ".cpp": []}
    for folder in FOLDERS:
        for path in (ROOT / folder).rglob("*.*"):
            if path.suffix in found:
                found[path.suffix] += [(n, name, path) for name, n in measure[path.suffix](path)]
    for suffix, functions in found.items():
        too_long = [one for one in functions if one[0] > MOST_LINES]
        assert not too_long, f"{suffix}: {too_long}"
    assert len(found[".py"]) > 4000
    assert len(found[".hpp"]) > 500


def test_readme_python_runs(tmp_path, monkeypatch, can_draw):
    """Run the README's Python blocks, one after the other, in a folder with the samples."""
    (tmp_path / "sample_data").symlink_to(ROOT / "sample_data")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    assert len(blocks) >= 3
    exec("\n".join(blocks), {})
    assert (tmp_path / "surface.geojson").exists()
    assert (tmp_path / "surface.html").exists()


PAGES = [page for page in list_pages() if page.name != "README.md" and read_blocks(page, "python")]


@pytest.fixture
def names_of_pages(tmp_path, monkeypatch):
    """Return what the pages speak of without making it, in a folder with the samples."""
    (tmp_path / "sample_data").symlink_to(ROOT / "sample_data")
    monkeypatch.chdir(tmp_path)
    survey = ts.read("sample_data/site_survey.csv", crs="EPSG:32616")
    ground = ts.triangulate(survey)
    pad = ts.lines_from_codes(ts.read("sample_data/design_pad.csv", crs="EPSG:32616"))
    middle = ground.points[:, :2].mean(axis=0)
    corners = np.array([[-9, -9], [9, -9], [9, 9], [-9, 9]])
    line = middle + np.array([[-40, -20], [40, 20]])
    ts.write(ts.rasterize(ground, spacing=2.0), "other.tif")
    write_grey(ground, Path("ortho.tif"))
    write_copc(Path("cloud.copc.laz"), make_cloud(400))
    ts.write(ts.Alignment.from_points(line, crs=ground.crs), "road.xml")
    lines = {"line": line, "centreline": line, "roads": ts.contours(ground, interval=2.0)}
    rings = {"ring": middle + corners, "polygon": middle + corners + np.array([25, 0])}
    edge = dict(zip("ab", ground.edges[0].tolist(), strict=True))
    points = {"xy": ground.points[:5, :2], "cloud": ground.points[:9] + np.array([0, 0, 1]), "v": 0}
    design = ts.triangulate(pad)
    surfaces = {"tin": ground, "ground": ground, "design": design, "pad": design}
    return {"ts": ts, "np": np, "survey": survey} | surfaces | lines | rings | edge | points


TOLD = (
    "Tiles of 512 pixels",
    "Pixels without data",
    "The unit of elevations is not known, and taken",
    "The elevations are not known above the ellipsoid",
)
"""Warnings that the pages speak of."""


@pytest.mark.slow
@pytest.mark.filterwarnings(*(f"ignore:.*{one}:tinsmith.LossWarning" for one in TOLD))
@pytest.mark.parametrize("page", PAGES, ids=name_page)
def test_python_of_the_pages_runs(page, names_of_pages):
    """Run the blocks of a page, one after the other."""
    exec("\n".join(block.text for block in read_blocks(page, "python")), names_of_pages)


SESSIONS = [page for page in list_pages() if read_blocks(page, "pycon")]


@pytest.mark.parametrize("page", SESSIONS, ids=name_page)
def test_sessions_of_the_pages_say_what_they_show(page, names_of_pages):
    """Run the examples of a page as one session."""
    text = "\n".join(block.text for block in read_blocks(page, "pycon"))
    session = doctest.DocTestParser().get_doctest(text, names_of_pages, page.stem, str(page), 0)
    said = []
    doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(session, out=said.append)
    assert said == []


@pytest.mark.slow
def test_readme_commands_run(tmp_path, monkeypatch, can_draw):
    """Run the first as a user does, the others, which need what it writes, in this process."""
    (tmp_path / "sample_data").symlink_to(ROOT / "sample_data")
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "README.md").read_text()
    lines = re.findall(r"^(tinsmith .*-o .*)$", text, re.MULTILINE)
    assert len(lines) == 5
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    result = run(*lines[0].split(), cwd=tmp_path, PATH=path)
    assert result.returncode == 0, result.stderr
    for line in lines[1:]:
        run_command(*line.split()[1:])
