"""The rules of the house: lint, types, import contract, one class each, light imports."""

import doctest
import importlib
import os
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest

import tinsmith
import tinsmith.cli

ROOT = Path(__file__).parents[1]


def run(*command, cwd=ROOT, **environment):
    return subprocess.run(
        command,
        cwd=cwd,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )


def tool(name):
    return str(Path(sys.executable).parent / name)


@pytest.fixture
def tree(tmp_path):
    """Mount the rooms as the one package that they are once installed."""
    package = tmp_path / "tinsmith"
    package.mkdir()
    for source in (ROOT / "src" / "tinsmith").iterdir():
        if source.name != "__pycache__":
            (package / source.name).symlink_to(source)
    for room in ("tin", "io", "terrain"):
        (package / room).symlink_to(ROOT / room)
    return tmp_path


def test_lint_and_formatting():
    for command in (("check", "."), ("format", "--check", ".")):
        result = run(tool("ruff"), *command)
        assert result.returncode == 0, result.stdout + result.stderr


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


def test_only_the_kernel_module_imports_the_core():
    users = [
        path.relative_to(ROOT).as_posix()
        for room in ("tin", "io", "terrain", "src")
        for path in (ROOT / room).rglob("*.py")
        if "import _core" in path.read_text()
    ]
    assert users == ["tin/_kernel.py"]


def test_rooms_are_never_imported_from_the_root():
    code = (
        "import sys, tinsmith as ts; ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]]);"
        "from tinsmith import io, terrain;"
        "assert not {'tin', 'terrain'} & set(sys.modules), 'a second copy of a room'"
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


def test_public_examples_run():
    """Run the examples of every docstring in every room."""
    names = ["tinsmith"]
    for room in (tinsmith.tin, tinsmith.io, tinsmith.terrain):
        names += [
            module.name for module in pkgutil.walk_packages(room.__path__, f"{room.__name__}.")
        ]
    tried = 0
    for name in names:
        if name.endswith("._core"):
            continue
        result = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
        assert result.failed == 0, name
        tried += result.attempted
    assert tried > 0


def test_readme_python_runs(tmp_path, monkeypatch, can_draw):
    """Run the README's Python blocks, one after the other, in a folder with the samples."""
    (tmp_path / "sample_data").symlink_to(ROOT / "sample_data")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    assert len(blocks) >= 3
    exec("\n".join(blocks), {})
    assert (tmp_path / "surface.geojson").exists()
    assert (tmp_path / "surface.png").exists()


def test_readme_commands_run(tmp_path, can_draw):
    (tmp_path / "sample_data").symlink_to(ROOT / "sample_data")
    text = (ROOT / "README.md").read_text()
    lines = re.findall(r"^(tinsmith .*-o .*)$", text, re.MULTILINE)
    assert len(lines) == 3
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    for line in lines:
        result = run(*line.split(), cwd=tmp_path, PATH=path)
        assert result.returncode == 0, result.stderr


def test_records_are_frozen():
    """All dataclasses but the two that collect while a file is read."""
    thawed = {}
    for folder in (tinsmith.tin, tinsmith.io, tinsmith.terrain, tinsmith.cli):
        for found in pkgutil.walk_packages(folder.__path__, f"{folder.__name__}."):
            module = importlib.import_module(found.name)
            for name, value in vars(module).items():
                how = getattr(value, "__dict__", {}).get("__dataclass_params__")
                if how is not None and not how.frozen:
                    thawed[name] = value
    assert sorted(thawed) == ["_Run", "_Top"]
