"""Try the wheels of a folder on a Debian machine that has Python and no compiler.

    python packaging/try_wheel.py dist trixie

pip of that machine chooses the wheel that fits its Python, and brings libraries as wheels; a user
without rights runs the jobs of try_jobs.py. Root, debootstrap and a network are needed.
"""

from __future__ import annotations

import sys
from pathlib import Path

from machines import REPOSITORY, Machine, open_machine

PACKAGES = ("python3", "python3-venv", "libegl1", "libgl1-mesa-dri")
USER = "1000:1000"
PYTHON = "/opt/tinsmith/bin/python"
PIP = (PYTHON, "-m", "pip", "--quiet", "--disable-pip-version-check")


def main(wheels: Path, suite: str) -> None:
    """Install and try on a machine of a suite."""
    with open_machine(suite, PACKAGES) as machine:
        found = machine.find_compilers()
        if found:
            raise SystemExit(f"The machine is not clean, it has {', '.join(found)}.")
        install(machine, wheels)
        machine.copy(REPOSITORY / "packaging" / "try_jobs.py", "/opt/try_jobs.py")
        machine.copy(REPOSITORY / "sample_data" / "site_survey.csv", "/opt/site_survey.csv")
        folder = machine.root / "home" / "user"
        folder.mkdir()
        folder.chmod(0o777)
        command = [PYTHON, "/opt/try_jobs.py", "/opt/site_survey.csv"]
        machine.run(command, user=USER, folder="/home/user", environment={"HOME": "/home/user"})


def install(machine: Machine, wheels: Path) -> None:
    """Install the wheel that fits there into an environment, with what it needs."""
    for wheel in wheels.glob("*.whl"):
        machine.copy(wheel, f"/opt/wheels/{wheel.name}")
    machine.run(["python3", "-m", "venv", "/opt/tinsmith"])
    chosen = ["download", "--no-deps", "--no-index", "--find-links", "/opt/wheels"]
    machine.run([*PIP, *chosen, "--dest", "/opt/chosen", "tinsmith"])
    (wheel,) = (machine.root / "opt" / "chosen").iterdir()
    sys.stdout.write(f"Installing {wheel.name}\n")
    sys.stdout.flush()
    machine.run([*PIP, "install", "--only-binary", ":all:", f"/opt/chosen/{wheel.name}"])


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
