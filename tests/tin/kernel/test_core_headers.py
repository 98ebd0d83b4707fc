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
COMPILER = os.environ.get("CXX") or "g++"
OPTIONS = [
    "-std=c++17",
    "-ffp-contract=off",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-pthread",
    f"-I{CORE}",
]
HEADERS = sorted(
    path.relative_to(CORE).as_posix()
    for path in CORE.rglob("*.hpp")
    if path.parent.name != "python"  # the bindings, which need nanobind
)
LONGEST_FUNCTION = 50
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


@needs_compiler
def test_the_core_works_without_python(tmp_path):
    """Built in every way, changed, located, refined; proven in C++ by the exact predicates."""
    program = tmp_path / "use_core"
    compile_with("-O1", ROOT / "tests" / "cpp" / "use_core.cpp", "-o", program)
    assert output_of(program) == "sound\n"


@needs_compiler
def test_the_example_prints_what_its_page_says(tmp_path):
    page = (CORE / "README.md").read_text()
    example, printed = re.findall(r"```(?:cpp)?\n(.+?)```", page, re.DOTALL)
    source, program = tmp_path / "example.cpp", tmp_path / "example"
    source.write_text(example)
    compile_with("-O1", source, "-o", program)
    assert output_of(program) == printed


def test_only_the_bindings_know_python():
    for path in [*CORE.rglob("*.hpp"), *CORE.rglob("*.inc")]:
        if path.parent.name != "python":
            assert not re.search(r"nanobind|Python\.h", path.read_text()), path


def test_the_page_lists_every_folder():
    listed = set(re.findall(r"^\| `(\w+)/` \|", (CORE / "README.md").read_text(), re.MULTILINE))
    assert listed == {path.name for path in CORE.iterdir() if path.is_dir()}


@pytest.mark.skipif(CLANG_FORMAT is None, reason="needs clang-format")
def test_formatting():
    sources = [
        str(path)
        for folder in (CORE, ROOT / "tests" / "cpp")
        for path in sorted(folder.rglob("*"))
        if path.suffix in {".hpp", ".cpp", ".inc"}
    ]
    done = subprocess.run(
        [CLANG_FORMAT, "--dry-run", "--Werror", *sources],
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
    for path in [*CORE.rglob("*.hpp"), *CORE.rglob("*.inc"), *CORE.rglob("*.cpp")]:
        for length, line in function_lengths(path.read_text()):
            assert length <= LONGEST_FUNCTION, f"{path.name}: {length} lines: {line}"
