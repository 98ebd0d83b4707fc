"""Do on a Debian machine, without Docker, what packaging/Dockerfile says, and try the result.

    python packaging/run_dockerfile.py

The official image of Python is not fetched: in its place stands Debian of the same suite, with
Debian's own Python of the same version. Root, debootstrap and a network are needed.
"""

from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
import tempfile
from contextlib import ExitStack
from pathlib import Path, PurePosixPath

from machines import REPOSITORY, SYSTEM_PATH, Machine, open_machine

DOCKERFILE = REPOSITORY / "packaging" / "Dockerfile"
# What the image python:VERSION-slim-SUITE has, by names of Debian.
PACKAGES = ("python3", "python3-venv", "python3-dev")
_IMAGE = re.compile(r"python:(\d\.\d+)-slim-(\w+)$")


class Stage:
    """A machine that follows the instructions of one stage."""

    def __init__(self, machine: Machine, version: str) -> None:
        self.machine = machine
        self.folder = "/"
        self.user = "root"
        self.environment = {"PATH": SYSTEM_PATH}
        self.entry: list[str] = []
        self.arguments: list[str] = []
        link = "ln -s /usr/bin/python3 /usr/local/bin/python; python --version"
        self.machine.run(["sh", "-euc", f'{link} | grep "Python {version}[.]"'])

    def follow(self, word: str, text: str, stages: dict[str, Stage], context: Path) -> None:
        """Do what an instruction says."""
        if word == "RUN":
            self.run(["sh", "-euc", text])
        elif word == "WORKDIR":
            self.folder = text
            (self.machine.root / text.lstrip("/")).mkdir(parents=True, exist_ok=True)
        elif word == "COPY":
            self.copy(shlex.split(text), stages, context)
        elif word == "ENV":
            name, value = shlex.split(text)[0].split("=", 1)
            self.environment[name] = value.replace(f"${name}", self.environment.get(name, ""))
        elif word == "USER":
            self.user = text
        elif word == "ENTRYPOINT":
            self.entry = json.loads(text)
        elif word == "CMD":
            self.arguments = json.loads(text)
        else:
            raise SystemExit(f"{DOCKERFILE}: {word} is not known here.")

    def copy(self, words: list[str], stages: dict[str, Stage], context: Path) -> None:
        """Copy what COPY names, from the context or another stage."""
        origin = context
        if words[0].startswith("--from="):
            origin = stages[words.pop(0).removeprefix("--from=")].machine.root
        *sources, target = words
        place = PurePosixPath(self.folder, target)
        for source in sources:
            path = origin / source.lstrip("/")
            is_inside = path.is_file() and (target.endswith("/") or len(sources) > 1)
            self.machine.copy(path, str(place / path.name if is_inside else place))

    def run(self, command: list[str]) -> None:
        """Run a command as the stage stands."""
        user = f"{self.user}:{self.user}"
        environment = {**self.environment, **({} if self.user == "root" else {"HOME": "/tmp"})}
        self.machine.run(command, user=user, folder=self.folder, environment=environment)


def read_instructions() -> list[tuple[str, str]]:
    """Return the instructions of the Dockerfile, each with its text."""
    lines = [line for line in DOCKERFILE.read_text().splitlines() if not line.startswith("#")]
    joined = "\n".join(lines).replace("\\\n", " ")
    pairs = [line.split(maxsplit=1) for line in joined.splitlines() if line.strip()]
    return [(word, text.strip()) for word, text in pairs]


def export_context(folder: Path) -> None:
    """Copy the tracked files that .dockerignore lets through."""
    let_through = [
        line[1:] for line in (REPOSITORY / ".dockerignore").read_text().split() if line[0] == "!"
    ]
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--", *let_through],
        cwd=REPOSITORY, check=True, capture_output=True, text=True,
    )  # fmt: skip
    for name in filter(None, listed.stdout.split("\0")):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes((REPOSITORY / name).read_bytes())


def build(stack: ExitStack, context: Path) -> Stage:
    """Follow the Dockerfile and return its last stage."""
    stages: dict[str, Stage] = {}
    for word, text in read_instructions():
        sys.stdout.write(f"{word} {text}\n")
        sys.stdout.flush()
        if word == "FROM":
            image, *alias = re.split(r"\s+AS\s+", text)
            version, suite = _IMAGE.match(image).groups()
            machine = stack.enter_context(open_machine(suite, PACKAGES, alias[0] if alias else ""))
            stage = Stage(machine, version)
            stages[alias[0] if alias else "last"] = stage
        else:
            stage.follow(word, text, stages, context)
    return stage


def main() -> None:
    """Build, and run the command as `docker run` would, with and without rights to the folder."""
    with ExitStack() as stack:
        context = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        export_context(context)
        stage = build(stack, context)
        found = stage.machine.find_compilers()
        if found:
            raise SystemExit(f"The image has compilers: {', '.join(found)}.")
        stage.run([*stage.entry, *stage.arguments])
        data = stage.machine.root / stage.folder.lstrip("/")
        data.chmod(0o777)  # the folder that `docker run --volume` would bring
        stage.machine.copy(REPOSITORY / "sample_data" / "site_survey.csv", "/data/survey.csv")
        stage.machine.copy(REPOSITORY / "packaging" / "try_jobs.py", "/data/try_jobs.py")
        stage.run([*stage.entry, *shlex.split("build survey.csv --crs EPSG:32616 -o tin.ply")])
        stage.run(["python", "try_jobs.py", "survey.csv"])


if __name__ == "__main__":
    main()
