"""The core as a C++ library: its headers without Python, its example, its formatting."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
CORE = ROOT / "tin" / "cpp"
PRODUCTS = ROOT / "terrain" / "cpp"  # kernels of terrain, which include headers of the core
COMPILER = os.environ.get("CXX") or "g++"
OPTIONS = [
    "-std=c++17",
    "-ffp-contract=off",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Werror",
    "-pthread",
    f"-I{CORE}",
    f"-I{PRODUCTS}",
]
HEADERS = sorted(
    path.relative_to(folder).as_posix()
    for folder in (CORE, PRODUCTS)
    for path in folder.rglob("*.hpp")
    if path.parent.name != "python"  # the bindings, which need nanobind
)
LONGEST_FUNCTION = 50


def list_sources(*suffixes, folders=(CORE, PRODUCTS)):
    found = [path for folder in folders for path in folder.rglob("*") if path.suffix in suffixes]
    assert len(found) > 2
    return sorted(found)


CLANG_FORMAT = shutil.which("clang-format", path=str(Path(sys.executable).parent)) or shutil.which(
    "clang-format"
)

needs_compiler = pytest.mark.skipif(shutil.which(COMPILER) is None, reason="needs a C++ compiler")


def compile_with(*arguments):
    done = subprocess.run(
        [COMPILER, *OPTIONS, *map(str, arguments)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def output_of(program):
    return subprocess.run([str(program)], check=True, capture_output=True, text=True).stdout


@needs_compiler
@pytest.mark.proof
@pytest.mark.parametrize("header", HEADERS)
def test_each_header_can_be_included_alone(header, tmp_path):
    source = tmp_path / "alone.cpp"
    source.write_text(f'#include "{header}"\n#include "{header}"\nint main() {{}}\n')
    compile_with("-fsyntax-only", source)


@pytest.mark.every_case("slow")
@pytest.mark.slow
@needs_compiler
@pytest.mark.parametrize("name", ["use_core", "use_products"])
def test_the_core_works_without_python(name, tmp_path):
    """Built in every way, changed, located, refined; proven in C++ by the exact predicates.

    What is derived from planes is known: contours, volumes, rasters.
    """
    program = tmp_path / name
    compile_with("-O0", ROOT / "tests" / "cpp" / f"{name}.cpp", "-o", program)
    assert output_of(program) == "sound\n"


@pytest.mark.slow
@needs_compiler
def test_no_header_warns(tmp_path):
    """All in one program, of the core and of terrain, with every warning an error."""
    source = tmp_path / "all.cpp"
    source.write_text("".join(f'#include "{header}"\n' for header in HEADERS) + "int main() {}\n")
    compile_with("-fsyntax-only", source)


def test_no_two_headers_have_one_name():
    names = [path.name for path in list_sources(".hpp", ".inc")]
    assert sorted(names) == sorted(set(names))


@pytest.mark.slow
@needs_compiler
def test_the_example_prints_what_its_page_says(tmp_path):
    page = (CORE / "README.md").read_text()
    example, printed = re.findall(r"```(?:cpp|text)\n(.+?)```", page, re.DOTALL)
    source, program = tmp_path / "example.cpp", tmp_path / "example"
    source.write_text(example)
    compile_with("-O0", source, "-o", program)
    assert output_of(program) == printed


def test_only_the_bindings_know_python():
    for path in list_sources(".hpp", ".inc"):
        if path.parent.name != "python":
            assert not re.search(r"nanobind|Python\.h", path.read_text()), path


def test_the_page_lists_every_folder():
    listed = set(re.findall(r"^\| `(\w+)/` \|", (CORE / "README.md").read_text(), re.MULTILINE))
    assert listed == {path.name for path in CORE.iterdir() if path.is_dir()}


@pytest.mark.skipif(CLANG_FORMAT is None, reason="needs clang-format")
def test_formatting():
    folders = [CORE, PRODUCTS, ROOT / "tests" / "cpp", ROOT / "benchmarks" / "compiled"]
    sources = list_sources(".hpp", ".cpp", ".inc", folders=folders)
    done = subprocess.run(
        [CLANG_FORMAT, "--dry-run", "--Werror", *map(str, sources)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr


def function_lengths(text):
    """Lines of each function's body: a brace after a parameter list or initialisers opens one."""
    code = re.sub(r'//[^\n]*|"(\\.|[^"\\\n])*"|\'(\\.|[^\'\\\n])\'', "", text)
    open_lines = []
    for number, line in enumerate(code.split("\n")):
        for at, sign in enumerate(line):
            if sign == "{":
                open_lines.append((number, line[:at].strip()))
            elif sign == "}":
                start, before = open_lines.pop()
                is_function = re.search(r"[)}]( const)?( noexcept)?( -> [\w:<>&* ]+)?$", before)
                is_statement = re.match(r"(} )?(if|for|while|switch|else)\b", before)
                if is_function and not is_statement and number > start:
                    yield number - start - 1, before


def test_functions_are_short():
    for path in list_sources(".hpp", ".inc", ".cpp"):
        for length, line in function_lengths(path.read_text()):
            assert length <= LONGEST_FUNCTION, f"{path.name}: {length} lines: {line}"
