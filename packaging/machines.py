"""Debian machines to try deliveries on: made by debootstrap, entered by chroot, thrown away.

Root, debootstrap and a network are needed.
"""

from __future__ import annotations

import shutil
import subprocess
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

REPOSITORY = Path(__file__).resolve().parents[1]
FOLDER = REPOSITORY / "build" / "machines"
CERTIFICATES = "etc/ssl/certs/ca-certificates.crt"
SYSTEM_PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
COMPILERS = ("cc", "c++", "gcc", "g++", "clang", "cmake", "make", "ninja")

# In namespaces of its own: what is mounted or started there ends with the command.
_ENTER = """
mount -t proc proc "$1/proc"
root=$1 user=$2; shift 2
exec chroot --userspec="$user" "$root" "$@"
"""


class Machine:
    """A machine in a folder, for commands as root or as a user without rights."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def run(
        self,
        command: Sequence[str],
        *,
        user: str = "0:0",
        folder: str = "/",
        environment: Mapping[str, str] | None = None,
    ) -> None:
        """Run a command there, with nothing of this environment; raise if it fails."""
        clean = {
            "PATH": SYSTEM_PATH,
            "HOME": "/tmp",
            "LANG": "C.UTF-8",
            "DEBIAN_FRONTEND": "noninteractive",
            "PIP_CERT": f"/{CERTIFICATES}",
            **(environment or {}),
        }
        settings = [f"{name}={value}" for name, value in clean.items()]
        inside = ["env", "-i", f"--chdir={folder}", *settings, *command]
        enter = ["unshare", "--mount", "--pid", "--fork", "sh", "-euc", _ENTER, "enter"]
        subprocess.run([*enter, str(self.root), user, *inside], check=True)

    def copy(self, source: Path, target: str) -> None:
        """Copy a file or folder of this machine to a place there."""
        place = self.root / target.lstrip("/")
        place.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, place, symlinks=True, dirs_exist_ok=True)
        else:
            shutil.copy(source, place)

    def find_compilers(self) -> list[str]:
        """Return the compilers and their tools that are installed there."""
        folders = [self.root / one.lstrip("/") for one in SYSTEM_PATH.split(":")]
        return [name for name in COMPILERS if any((one / name).exists() for one in folders)]


@contextmanager
def open_machine(suite: str, packages: Sequence[str], name: str = "") -> Iterator[Machine]:
    """Make a machine of a suite of Debian with some packages; remove it in the end."""
    base = _make_base(suite, packages)
    root = FOLDER / "running" / f"{base.name}{name}"
    shutil.rmtree(root, ignore_errors=True)
    root.parent.mkdir(exist_ok=True)
    subprocess.run(["cp", "--archive", "--reflink=auto", str(base), str(root)], check=True)
    machine = Machine(root)
    try:
        for file in ("etc/resolv.conf", CERTIFICATES):
            machine.copy(Path("/", file), file)
        yield machine
    finally:
        shutil.rmtree(root)


def _make_base(suite: str, packages: Sequence[str]) -> Path:
    """Return the folder of a fresh machine, which is made once."""
    base = FOLDER / "-".join([suite, *packages])
    if base.exists():
        return base
    part = base.with_name(base.name + ".part")
    shutil.rmtree(part, ignore_errors=True)
    part.parent.mkdir(parents=True, exist_ok=True)
    wanted = ",".join([*packages, "ca-certificates"])
    command = ["debootstrap", "--variant=minbase", f"--include={wanted}", suite, str(part)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    part.rename(base)
    return base
