"""Draw mutants of the package or its core, run the tests that name their module, list survivors.

A mutant is noticed if a test fails, hangs or crashes. Survivors are to be judged one by one: a test
is missing, or the change changes nothing (an equivalent mutant).
"""

from __future__ import annotations

import argparse
import ast
import json
import os
import random
import re
import shutil
import subprocess
import sys
import sysconfig
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue
from typing import NamedTuple

from .changes import Change, cpp_changes, python_changes

ROOT = Path(__file__).resolve().parents[2]
TESTS = ROOT / "tests"
BUILD = ROOT / "build" / "mutants"
PLACES = {"tin": "tin", "io": "io", "terrain": "terrain", "src/tinsmith": ""}
MOST_FILES = 8
CORE_TESTS = (
    "test_tin_predicates", "test_tin_growth", "test_tin_kernel_seams", "test_tin_points",
    "test_tin_locate", "test_tin_rings", "test_tin_mesh", "test_tin_editing", "test_tin_noding",
    "test_tin_lines", "test_tin_refine", "test_tin_threads", "test_tin_kernel_work",
    "test_tin_duplicates", "test_tin_kernel_datasets",
)  # fmt: skip


class Mutant(NamedTuple):
    """A change of a file, and the test files that should notice it."""

    path: Path
    change: Change
    tests: tuple[Path, ...]

    def describe(self) -> str:
        text = self.path.read_text()
        line = text.count("\n", 0, self.change.start) + 1
        words = text.splitlines()[line - 1].strip()
        return f"{self.path.relative_to(ROOT)}:{line}: {self.change.what}   in: {words}"


# ---------------------------------------------------------------------------- drawing


def python_files() -> list[Path]:
    return sorted(
        path for place in PLACES for path in (ROOT / place).rglob("*.py") if "cpp" not in path.parts
    )


def tests_of(path: Path) -> tuple[Path, ...]:
    """Test files that name a module or what it defines, those that name it most first."""
    tree = ast.parse(path.read_text())
    kinds = (ast.FunctionDef, ast.ClassDef)
    public = {node.name for node in tree.body if isinstance(node, kinds)}
    public = {name for name in public if not name.startswith("_")} | {path.stem}
    pattern = re.compile(rf"\b({'|'.join(map(re.escape, sorted(public)))})\b")
    room = PLACES[next(p for p in PLACES if path.is_relative_to(ROOT / p))] or "cli"
    scores = {}
    for test in sorted(TESTS.rglob("test_*.py")):
        score = len(pattern.findall(test.read_text()))
        score += 50 * (f"test_{room}_{path.stem.split('_')[0]}" in test.stem)
        score *= 3 if test.stem.startswith(f"test_{room}") else 1
        scores[test] = score
    best = sorted((t for t in scores if scores[t]), key=lambda t: -scores[t])[:MOST_FILES]
    return tuple(best) or tuple(sorted(TESTS.glob(f"test_{room}_*.py")))


def draw(kind: str, count: int, seed: int, only: str) -> list[Mutant]:
    """Draw changes, each of them equally likely."""
    if kind == "python":
        files, changes = python_files(), python_changes
    else:
        files, changes = sorted((ROOT / "tin" / "cpp").rglob("*.hpp")), cpp_changes
    files = [path for path in files if only in str(path.relative_to(ROOT))]
    everything = [(path, change) for path in files for change in changes(path.read_text())]
    chosen = random.Random(seed).sample(everything, min(count, len(everything)))
    core = tuple(path for n in CORE_TESTS if (path := TESTS / f"{n}.py").exists())
    return [Mutant(p, c, tests_of(p) if kind == "python" else core) for p, c in chosen]


# ---------------------------------------------------------------------------- running


class Workshop:
    """A copy of the package of its own, in which one mutant after the other lives."""

    def __init__(self, number: int, kind: str) -> None:
        self.folder = BUILD / f"{kind}-{number}"
        shutil.rmtree(self.folder / "tree", ignore_errors=True)
        package = self.folder / "tree" / "tinsmith"
        ignored = shutil.ignore_patterns("cpp", "__pycache__")
        for place, inside in sorted(PLACES.items(), key=lambda item: item[1]):
            shutil.copytree(ROOT / place, package / inside, ignore=ignored, dirs_exist_ok=True)
        shutil.copy(TESTS / "sanitizers" / "sitecustomize.py", self.folder / "tree")
        self.core = package / "tin" / f"_core{sysconfig.get_config_var('EXT_SUFFIX')}"
        if kind == "python":
            shutil.copy(installed_core(), self.core)
        else:
            self._copy_sources()

    def _copy_sources(self) -> None:
        source = self.folder / "source"
        shutil.copytree(ROOT / "tin" / "cpp", source / "tin" / "cpp", dirs_exist_ok=True)
        shutil.copy(ROOT / "CMakeLists.txt", source)
        nanobind = subprocess.check_output([sys.executable, "-m", "nanobind", "--cmake_dir"])
        subprocess.run(
            ["cmake", "-S", source, "-B", self.folder / "cmake", "-G", "Ninja",
             f"-DPython_EXECUTABLE={sys.executable}", f"-Dnanobind_DIR={nanobind.decode().strip()}",
             "-DTINSMITH_FAST_BUILD=ON"],
            check=True, capture_output=True,
        )  # fmt: skip

    def judge(self, mutant: Mutant, limit: float) -> str:
        """Return "noticed", "hangs", "does not compile" or "SURVIVED"."""
        target = self._target(mutant.path)
        text = mutant.path.read_text()
        target.write_text(mutant.change.applied(text))
        try:
            if mutant.path.suffix == ".py":
                compile(target.read_text(), str(target), "exec")
            elif not self._build():
                return "does not compile"
            return self._test(mutant.tests, limit)
        finally:
            target.write_text(text)

    def _target(self, path: Path) -> Path:
        if path.suffix == ".hpp":
            return self.folder / "source" / path.relative_to(ROOT)
        place = next(p for p in PLACES if path.is_relative_to(ROOT / p))
        return self.folder / "tree" / "tinsmith" / PLACES[place] / path.relative_to(ROOT / place)

    def _build(self) -> bool:
        done = subprocess.run(["cmake", "--build", self.folder / "cmake"], capture_output=True)
        if done.returncode == 0:
            shutil.copy(next((self.folder / "cmake").glob("_core.*so")), self.core)
        return done.returncode == 0

    def _test(self, tests: tuple[Path, ...], limit: float) -> str:
        options = ["-q", "-x", "-p", "no:cacheprovider", "--hypothesis-seed=1"]
        options.append(f"--timeout={limit / 3:.0f}")
        command = [sys.executable, "-m", "pytest", *options, *map(str, tests)]
        environment = {
            **os.environ,
            "PYTHONPATH": f"{self.folder / 'tree'}:{TESTS}",
            "HYPOTHESIS_STORAGE_DIRECTORY": str(self.folder / "hypothesis"),
            "PYTHONDONTWRITEBYTECODE": "1",
        }
        try:
            done = subprocess.run(
                command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=limit
            )
        except subprocess.TimeoutExpired:
            return "hangs"
        (self.folder / "last.log").write_text(done.stdout + done.stderr)
        return "SURVIVED" if done.returncode == 0 else "noticed"


def installed_core() -> str:
    import tinsmith.tin._core as core

    return str(core.__file__)


def run(mutants: list[Mutant], kind: str, jobs: int, limit: float) -> dict[str, list[str]]:
    """Judge all mutants; return their descriptions by verdict."""
    workshops: SimpleQueue[Workshop] = SimpleQueue()
    for number in range(jobs):
        workshops.put(Workshop(number, kind))
    verdicts: dict[str, list[str]] = {}

    def judge(mutant: Mutant) -> None:
        workshop = workshops.get()
        try:
            began = time.monotonic()
            verdict = workshop.judge(mutant, limit)
            verdicts.setdefault(verdict, []).append(mutant.describe())
            seconds = time.monotonic() - began
            print(f"{verdict:<16} {seconds:6.1f} s  {mutant.describe()}", flush=True)
        finally:
            workshops.put(workshop)

    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(judge, mutants))
    return verdicts


def main() -> int:
    parser = argparse.ArgumentParser("python -m mutation", description=__doc__)
    add = parser.add_argument
    add("kind", choices=("python", "core"))
    add("--count", type=int, default=150, help="how many mutants to draw [150]")
    add("--seed", type=int, default=1)
    add("--jobs", type=int, default=os.cpu_count() or 1)
    add("--limit", type=float, default=300.0, help="seconds for the tests of a mutant [300]")
    add("--only", default="", metavar="TEXT", help="files whose path holds this text")
    given = parser.parse_args()
    mutants = draw(given.kind, given.count, given.seed, given.only)
    verdicts = run(mutants, given.kind, given.jobs, given.limit)
    survivors = sorted(verdicts.get("SURVIVED", []))
    BUILD.mkdir(parents=True, exist_ok=True)
    (BUILD / f"{given.kind}-{given.seed}.json").write_text(json.dumps(verdicts, indent=1))
    n_judged = sum(len(v) for k, v in verdicts.items() if k != "does not compile")
    share = 100 * (1 - len(survivors) / max(1, n_judged))
    print(f"\n{n_judged} mutants, seed {given.seed}: {share:.1f} % noticed. Survivors:")
    print("\n".join(f"  {one}" for one in survivors) or "  none")
    return 0


if __name__ == "__main__":
    sys.exit(main())
