"""Draw mutants of the package or its core, run the tests that run their place, list survivors.

Which tests run a place of Python is in a map that `map` builds once (minutes); without it, the test
files that name the module are run. A mutant is noticed if a test fails, hangs or crashes; tests
that took least time run first, and the first that fails ends the run. Survivors are to be judged
one by one: a test is missing, or the change changes nothing that can be relied on (an equivalent
mutant). Those that were judged so stand in `judged.toml`, each with its reason, and are not run
again.
"""

from __future__ import annotations

import argparse
import ast
import compileall
import json
import math
import os
import random
import re
import shutil
import subprocess
import sys
import sysconfig
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module
from pathlib import Path
from py_compile import PycInvalidationMode
from queue import SimpleQueue
from typing import NamedTuple

from .changes import Change, cpp_changes, python_changes
from .coverage_map import CoverageMap

ROOT = Path(__file__).resolve().parents[2]
TESTS = ROOT / "tests"
BUILD = ROOT / "build" / "mutants"
PLACES = {
    "tin": Path("tin"), "io": Path("io"), "terrain": Path("terrain"), "src/tinsmith": Path(),
}  # fmt: skip
DURATIONS = BUILD / "durations.json"
MAP = BUILD / "map"
JUDGED = tomllib.loads((Path(__file__).parent / "judged.toml").read_text())["mutant"]
NOT_RUN = ("does not compile", "judged", "unsure", "out of time", "not begun")
MOST_FILES = 8
CORE_TESTS = (
    "kernel/test_predicates", "kernel/test_growth", "kernel/test_seams", "validation/test_points",
    "kernel/test_locate", "kernel/test_point_in_polygon", "kernel/test_mesh",
    "kernel/test_edited_mesh", "editing/test_session", "editing/test_single_edits",
    "constraints/test_noding", "constraints/test_breaklines", "meshing/test_refinement",
    "test_threads", "kernel/test_work", "building/test_duplicates", "kernel/test_datasets",
)  # fmt: skip
NEAREST = {
    "location": ("kernel/test_locate",),
    "constraints": (
        "constraints/test_noding", "constraints/test_breaklines", "kernel/test_point_in_polygon",
        "kernel/test_contacts",
    ),
    "mesh": (
        "kernel/test_mesh", "kernel/test_edited_mesh", "editing/test_single_edits",
        "editing/test_session", "constraints/test_breaklines",
    ),
    "refinement": (
        "kernel/test_error_bounds", "meshing/test_refinement", "constraints/test_conforming",
    ),
    "predicates": ("kernel/test_predicates", "kernel/test_error_bounds"),
    "points": ("validation/test_points", "building/test_duplicates"),
}  # fmt: skip
"""Test files that are likeliest to notice changes in a folder of the core; they run first."""

CAMPAIGNS = {
    "tin/editing": ("edits",),
    "tin/constraints": ("lines", "islands", "conforming", "edits"),
    "tin/building": ("points", "lines", "edits"),
    "tin/checking": ("lines", "conforming"),
    "tin/meshing": ("refine",),
    "tin/voronoi": ("voronoi",),
    "tin/paper": (),
    "tin/cpp/refinement": ("refine", "conforming"),
    "tin/cpp": ("points", "lines", "edits", "conforming"),
    "tin": ("arguments", "points", "lines", "edits", "roundtrip"),
    "io/delimited": ("survey text", "damaged survey text", "readers-delimited"),
    "io/mesh": tuple(f"readers-{name}" for name in ("ply", "obj", "stl", "vtk", "gmsh")),
    "io/raster": ("readers-raster",),
    "io/vector": ("readers-vectors",),
    "io": ("roundtrip", "units"),
    "terrain": ("units",),
    "src/tinsmith": ("commands", "arguments", "units"),
}
"""Campaigns that are about a folder, the innermost first; `make test` runs 40 cases of each."""

CASES, CASES_SEED = 40, 20
BUILDERS = ("validation/test_points", "kernel/test_growth", "kernel/test_seams")
OF_ALL_MODULES = (
    "tests/test_values.py", "tests/cli/test_options.py",
    "tests/test_api.py::test_public_names_are_those_of_the_snapshot",
)  # fmt: skip
"""Tests that look at what modules define, without running a line of them; they run last."""

NO_TESTS = 5
N_NEAREST = 3
SECONDS_OF_TESTS = 10.0
"""Of the tests that run a place, the shortest that together take so long are run, unless told
otherwise."""


class Mutant(NamedTuple):
    """A change of a file, and the tests or test files that should notice it, in stages."""

    path: Path
    change: Change
    tests: tuple[tuple[str, ...], ...] = ()

    def describe(self) -> str:
        line, column, words = self.place()
        return f"{self.path.relative_to(ROOT)}:{line}:{column}: {self.change.what}   in: {words}"

    def place(self) -> tuple[int, int, str]:
        """Return the number of the changed line, the column in it, and its words."""
        text = self.path.read_text()
        line = text.count("\n", 0, self.change.start) + 1
        column = self.change.start - text.rfind("\n", 0, self.change.start)
        return line, column, text.splitlines()[line - 1].strip()

    def is_judged(self) -> bool:
        """Whether it is known to change nothing; `from` tells places in a line apart."""
        _, _, words = self.place()
        after = self.path.read_text()[self.change.start :].splitlines()[0].strip()
        known = (str(self.path.relative_to(ROOT)), self.change.what, words, after)
        return any(
            known == (one["path"], one["change"], one["line"], one.get("from", after))
            for one in JUDGED
        )


# ---------------------------------------------------------------------------- drawing


def python_files() -> list[Path]:
    return sorted(
        path for place in PLACES for path in (ROOT / place).rglob("*.py") if "cpp" not in path.parts
    )


def tests_of(path: Path) -> tuple[Path, ...]:
    """Test files of a module, by what they name, then those of the modules that import it."""
    own = ranked_tests(path, {path.stem}, names_of(path))
    if path.stem.endswith("child"):  # run by a server of processes, whose lines no test can trace
        folder = TESTS / inside_package(path).parent
        own = (*own, *sorted(folder.rglob("test_*.py")))
        return tuple(dict.fromkeys(own))
    both = dict.fromkeys((*own, *ranked_tests(path, *importers_of(path))))
    return tuple(both)[:MOST_FILES] or tuple(sorted((TESTS / room_of(path)).rglob("test_*.py")))


def room_of(path: Path) -> str:
    return inside_package(path).parts[0]


def names_of(path: Path) -> set[str]:
    tree = ast.parse(path.read_text())
    kinds = (ast.FunctionDef, ast.ClassDef)
    public = {node.name for node in tree.body if isinstance(node, kinds)}
    return {name for name in public if not name.startswith("_")}


def importers_of(path: Path) -> tuple[set[str], set[str]]:
    imports = re.compile(rf"from [.\w]*\b{path.stem} import|import .*\b{path.stem}\b")
    users = [one for one in python_files() if one != path and imports.search(one.read_text())]
    return {one.stem for one in users}, {name for one in users for name in names_of(one)}


def ranked_tests(path: Path, modules: set[str], names: set[str]) -> tuple[Path, ...]:
    """Return the test files that import some of the modules or hold the names most often."""
    if not modules:
        return ()
    imported = rf"import .*\b(?:{any_of(modules)})\b|from .*\b(?:{any_of(modules)}) import"
    pattern = re.compile(rf"{imported}|\b(?:{any_of(names)})\b" if names else imported)
    mirrored = TESTS / inside_package(path).parent / f"test_{path.stem}.py"
    scores = {}
    for test in sorted(TESTS.rglob("test_*.py")):
        text = test.read_text().replace("from __future__ import annotations", "")
        score = len(pattern.findall(text))
        score += 50 * (test == mirrored)
        score *= 3 if test.is_relative_to(TESTS / room_of(path)) else 1
        scores[test] = score
    return tuple(sorted((t for t in scores if scores[t]), key=lambda t: -scores[t])[:MOST_FILES])


def any_of(words: set[str]) -> str:
    return "|".join(map(re.escape, sorted(words)))


def draw(kind: str, count: int, seed: int, only: str) -> list[Mutant]:
    """Draw changes, each of them equally likely."""
    if kind == "python":
        files, changes = python_files(), python_changes
    else:
        files, changes = sorted(ROOT.glob("t*/cpp/**/*.hpp")), cpp_changes
    name, _, line = only.partition(":")
    files = [path for path in files if name in str(path.relative_to(ROOT))]
    everything = [(path, change) for path in files for change in changes(path.read_text())]
    if line:
        everything = [(p, c) for p, c in everything if Mutant(p, c).place()[0] == int(line)]
    chosen = random.Random(seed).sample(everything, min(count, len(everything)))
    return [Mutant(path, change) for path, change in chosen]


def staged(mutant: Mutant, kind: str, known: CoverageMap, seconds: float) -> Mutant:
    """Return a mutant with its tests: the likeliest files first, as to collect all takes long."""
    if kind == "core":
        return mutant._replace(tests=file_stages(core_tests_of(mutant.path)))
    files = [str(path.relative_to(ROOT)) for path in tests_of(mutant.path)]
    inside = str(inside_package(mutant.path))
    tests = known.tests_of(inside, mutant.path.read_text(), mutant.place()[0])
    if not tests:
        return mutant._replace(tests=file_stages(tests_of(mutant.path)))
    held = {file: sum(test.startswith(f"{file}::") for test in tests) for file in files}
    near = [file for file in files if held[file]][:N_NEAREST]
    first = [test for test in tests if test.partition("::")[0] in near]
    rest = [test for test in tests if test not in set(first)]
    near_and_far = (affordable(first, known, seconds), affordable(rest, known, seconds))
    return mutant._replace(tests=(*near_and_far, OF_ALL_MODULES))


def affordable(tests: list[str], known: CoverageMap, seconds: float) -> tuple[str, ...]:
    """Return the first tests, which are the shortest, as far as there is time; one at least."""
    total, chosen = 0.0, []
    for test in tests:
        total += known.seconds.get(test, 0.05)
        if chosen and total > seconds:
            break
        chosen.append(test)
    return tuple(chosen)


def file_stages(files: tuple[Path, ...]) -> tuple[tuple[str, ...], ...]:
    names = tuple(str(path.relative_to(ROOT)) for path in files)
    return names[:N_NEAREST], names[N_NEAREST:]


def inside_package(path: Path) -> Path:
    place = next(p for p in PLACES if path.is_relative_to(ROOT / p))
    return PLACES[place] / path.relative_to(ROOT / place)


def core_tests_of(path: Path) -> tuple[Path, ...]:
    names = dict.fromkeys((*NEAREST.get(path.parent.name, BUILDERS), *CORE_TESTS))
    return tuple(TESTS / "tin" / f"{name}.py" for name in names)


def campaigns_of(path: Path) -> tuple[str, ...]:
    """Return the campaigns of the innermost folder that has some."""
    folders = [folder for folder in CAMPAIGNS if path.is_relative_to(ROOT / folder)]
    return CAMPAIGNS[max(folders, key=len)] if folders else ()


# ---------------------------------------------------------------------------- running


class Workshop:
    """A copy of the package of its own, in which one mutant after the other lives."""

    def __init__(self, number: int, kind: str) -> None:
        self.folder = BUILD / f"{kind}-{number}"
        self.kind = kind
        self.noticed_by = ""
        shutil.rmtree(self.folder / "tree", ignore_errors=True)
        package = self.folder / "tree" / "tinsmith"
        ignored = shutil.ignore_patterns("cpp", "__pycache__")
        for place, inside in sorted(PLACES.items(), key=lambda item: item[1]):
            shutil.copytree(ROOT / place, package / inside, ignore=ignored, dirs_exist_ok=True)
        shutil.copy(TESTS / "mutation" / "sitecustomize.py", self.folder / "tree")
        how = PycInvalidationMode.CHECKED_HASH  # two mutants may be written in one second
        compileall.compile_dir(package, quiet=2, invalidation_mode=how)
        name = f"_core{sysconfig.get_config_var('EXT_SUFFIX')}"
        self.cores = {"": package / "tin" / name, "terrain": package / "terrain" / name}
        if kind == "python":
            for room, core in self.cores.items():
                shutil.copy(installed_core(room or "tin"), core)
        else:
            self._copy_sources()

    def _copy_sources(self) -> None:
        source = self.folder / "source"
        for folder in (Path("tin", "cpp"), Path("terrain", "cpp"), Path("tests", "cpp")):
            shutil.copytree(ROOT / folder, source / folder, dirs_exist_ok=True)
        shutil.copy(ROOT / "CMakeLists.txt", source)
        nanobind = subprocess.check_output([sys.executable, "-m", "nanobind", "--cmake_dir"])
        subprocess.run(
            ["cmake", "-S", source, "-B", self.folder / "cmake", "-G", "Ninja",
             f"-DPython_EXECUTABLE={sys.executable}", f"-Dnanobind_DIR={nanobind.decode().strip()}",
             "-DTINSMITH_FAST_BUILD=ON"],
            check=True, capture_output=True,
        )  # fmt: skip

    def judge(self, mutant: Mutant, limit: float) -> str:
        """Return "noticed", "SURVIVED", or a word for what was not run to its end."""
        if mutant.is_judged():
            return "judged"
        target = self._target(mutant.path)
        text = mutant.path.read_text()
        target.write_text(mutant.change.applied(text))
        try:
            if mutant.path.suffix == ".py":
                compile(target.read_text(), str(target), "exec")
            elif not self._build():
                return "does not compile"
            return self._test(mutant, limit)
        finally:
            target.write_text(text)

    def restore(self) -> None:
        """Build the core without a mutant; the last one may live in it."""
        if self.kind == "core":
            self._build()

    def _target(self, path: Path) -> Path:
        if path.suffix == ".hpp":
            return self.folder / "source" / path.relative_to(ROOT)
        return self.folder / "tree" / "tinsmith" / inside_package(path)

    def _build(self) -> bool:
        done = subprocess.run(["cmake", "--build", self.folder / "cmake"], capture_output=True)
        if done.returncode == 0:
            for folder, core in self.cores.items():
                shutil.copy(next((self.folder / "cmake" / folder).glob("_core.*so")), core)
        return done.returncode == 0

    def _test(self, mutant: Mutant, limit: float) -> str:
        end = time.monotonic() + limit
        for tests in mutant.tests:
            verdict = self.run_tests(tests, end - time.monotonic()) if tests else "SURVIVED"
            if verdict != "SURVIVED":
                return verdict
        return self.run_campaigns(campaigns_of(mutant.path), end - time.monotonic())

    def run_campaigns(self, names: tuple[str, ...], limit: float) -> str:
        """Run the cases of campaigns that `make test` runs."""
        if not names:
            return "SURVIVED"
        options = ["--cases", str(CASES), "--seed", str(CASES_SEED), "--shrink-seconds", "0"]
        options += ["--jobs", "1", "--folder", str(self.folder / "finds")]
        options += [word for name in names for word in ("--campaign", name)]
        command = [sys.executable, "-m", "fuzz", *options]
        try:
            done = subprocess.run(
                command, cwd=ROOT, env=self.environment(), capture_output=True, timeout=limit
            )
        except subprocess.TimeoutExpired:
            return "out of time"
        self.noticed_by = f"a campaign: {', '.join(names)}"
        return "SURVIVED" if done.returncode == 0 else "noticed"

    def run_tests(self, tests: tuple[str, ...], limit: float) -> str:
        chosen = self.folder / "chosen.json"
        chosen.write_text(json.dumps(tests))
        files = sorted({test.partition("::")[0] for test in tests})
        options = ["-q", "-x", "-p", "no:cacheprovider", "-p", "mutation.shortest_first"]
        command = [sys.executable, "-m", "pytest", *options, "--hypothesis-seed=1", *files]
        environment = self.environment() | {"MUTATION_CHOSEN": str(chosen)}
        try:
            done = subprocess.run(
                command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=limit
            )
        except subprocess.TimeoutExpired:
            return "out of time"
        (self.folder / "last.log").write_text(done.stdout + done.stderr)
        failed = re.search(r"^(?:FAILED|ERROR) ([^\s\[]+)", done.stdout, re.MULTILINE)
        self.noticed_by = failed[1] if failed else "a crash or hang"
        return "SURVIVED" if done.returncode in (0, NO_TESTS) else "noticed"

    def environment(self) -> dict[str, str]:
        return {
            **os.environ,
            "PYTHONPATH": f"{self.folder / 'tree'}:{TESTS}",
            "HYPOTHESIS_STORAGE_DIRECTORY": str(self.folder / "hypothesis"),
            "MUTATION_DURATIONS": str(DURATIONS),
            "TINSMITH_SOURCES": str(self.folder / "source" if self.kind == "core" else ROOT),
        }

    def map_coverage(self, only: str) -> int:
        """Follow all tests, or add those of some files to the map; return the exit status."""
        # These say little of one line.
        slow = ("test_fuzz.py", "test_repository.py", "test_benchmarks.py")
        tests = [path for path in sorted(TESTS.rglob("test_*.py")) if only in str(path)]
        tests = [path for path in tests if only or path.name not in slow]
        if not only:
            shutil.rmtree(MAP, ignore_errors=True)
        package = str(self.folder / "tree" / "tinsmith")
        options = ["-q", "-p", "no:cacheprovider", "-p", "mutation.shortest_first"]
        options += ["--timeout", "0"]  # followed line by line a test takes many times as long
        return subprocess.run(
            [sys.executable, "-m", "pytest", *options, "-p", "mutation.tracing", *map(str, tests)],
            cwd=ROOT, check=False,
            env={**self.environment(), "MUTATION_PACKAGE": package, "MUTATION_MAP": str(MAP)},
        ).returncode  # fmt: skip


def installed_core(package: str) -> str:
    return str(import_module(f"tinsmith.{package}._core").__file__)


def run(mutants: list[Mutant], given: argparse.Namespace) -> dict[str, list[str]]:
    """Judge all mutants, or those that there is time for; return their descriptions by verdict."""
    again = "-again" if given.again else ""
    results = BUILD / f"{given.kind}-{given.seed}{again}.json"
    deadline = time.monotonic() + 60 * given.minutes
    workshops: SimpleQueue[Workshop] = SimpleQueue()
    known = CoverageMap(MAP, DURATIONS)
    for number in range(given.jobs):
        workshops.put(Workshop(number, given.kind))
    verdicts: dict[str, list[str]] = {}
    noticed: dict[str, list[str]] = {}

    def judge(mutant: Mutant) -> None:
        workshop = workshops.get()
        try:
            began = time.monotonic()
            verdict = "not begun"
            if began < deadline:
                whole = staged(mutant, given.kind, known, given.seconds)
                verdict = workshop.judge(whole, given.limit)
            verdicts.setdefault(verdict, []).append(mutant.describe())
            seconds = time.monotonic() - began
            by = f"\n    by {workshop.noticed_by}" if verdict == "noticed" else ""
            if verdict == "noticed":
                noticed.setdefault(workshop.noticed_by, []).append(mutant.describe())
            results.write_text(json.dumps(verdicts, indent=1))
            if verdict != "not begun":
                print(f"{verdict:<16} {seconds:6.1f} s  {mutant.describe()}{by}", flush=True)
        finally:
            workshops.put(workshop)

    with ThreadPoolExecutor(given.jobs) as pool:
        list(pool.map(judge, mutants))
    workshop = workshops.get()
    workshop.restore()
    for mutant in unsure(workshop, noticed, given.limit):
        verdicts["noticed"].remove(mutant)
        verdicts.setdefault("unsure", []).append(mutant)
    results.write_text(json.dumps(verdicts, indent=1))
    return verdicts


def unsure(workshop: Workshop, noticed: dict[str, list[str]], limit: float) -> list[str]:
    """Return the mutants that were noticed by a test that fails without a mutant, too."""
    failing = []
    for test, mutants in noticed.items():
        if "::" in test and workshop.run_tests((test,), limit) != "SURVIVED":
            print(f"fails without a mutant, too: {test}")
            failing += mutants
    return failing


def main() -> int:
    parser = argparse.ArgumentParser("python -m mutation", description=__doc__)
    add = parser.add_argument
    add("kind", choices=("python", "core", "map"))
    add("--count", type=int, default=150, help="how many mutants to draw [150]")
    add("--seed", type=int, default=1)
    add("--jobs", type=int, default=os.cpu_count() or 1)
    add("--limit", type=float, default=300.0, help="seconds for the tests of a mutant [300]")
    add(
        "--seconds", type=float, default=SECONDS_OF_TESTS, metavar="S",
        help=f"of the tests that run a place, the shortest that take so long [{SECONDS_OF_TESTS}]",
    )  # fmt: skip
    add("--again", type=Path, metavar="FILE", help="only those that lived by these results")
    add("--skip", type=int, default=0, help="of the mutants drawn, leave out the first so many")
    add("--minutes", type=float, default=math.inf, help="begin no mutant after so many [all]")
    add(
        "--only",
        default="",
        metavar="TEXT",
        help="files whose path holds this (of tests for map), or PATH:LINE",
    )
    given = parser.parse_args()
    BUILD.mkdir(parents=True, exist_ok=True)
    if given.kind == "map":
        return Workshop(0, "python").map_coverage(given.only)
    mutants = draw(given.kind, given.count, given.seed, given.only)[given.skip :]
    if given.again:
        lived = set(json.loads(given.again.read_text())["SURVIVED"])
        mutants = [mutant for mutant in mutants if mutant.describe() in lived]
    verdicts = run(mutants, given)
    survivors = sorted(verdicts.get("SURVIVED", []))
    n_run = sum(len(v) for k, v in verdicts.items() if k not in NOT_RUN)
    share = 100 * (1 - len(survivors) / max(1, n_run))
    print(f"\n{n_run} mutants, seed {given.seed}: {share:.1f} % noticed. Survivors:")
    print("\n".join(f"  {one}" for one in survivors) or "  none")
    print(
        "".join(f"{word}: {len(verdicts[word])}\n" for word in NOT_RUN if word in verdicts), end=""
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
