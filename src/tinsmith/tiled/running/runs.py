"""The folder of a run: what is computed, from what, and what became of each task.

A run that was killed goes on where it was: a task is done when its record is there, and records
are written last. Other options, or inputs that have changed, are refused with the difference.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import socket
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...base.atomic import find_leftovers, replacing
from ...base.errors import MissingExtraError, ReadError, TinsmithError, WriteError
from ...base.notes import list_collected
from ...base.sentences import counted

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

_MANIFEST = "run.json"
_LOCK = "lock"
_BESIDE = "beside.json"
_SIZE_OF_ENDS = 1 << 16
_SHOWN = 3


class UnfinishedError(ReadError):
    """Tasks failed; what is done is kept. The same call tries these again, if that may help."""


@dataclass(frozen=True)
class Fingerprint:
    """What tells whether an input is the one that it was.

    Attributes
    ----------
    path : str
        Absolute.
    size : int
        Bytes.
    changed : int
        When it was last written, in nanoseconds.
    ends : str
        Hash of its first and last bytes.
    """

    path: str
    size: int
    changed: int
    ends: str

    @classmethod
    def take(cls, path: Path) -> Fingerprint:
        """Look at a file.

        Raises
        ------
        ReadError
            If it is not there, or cannot be read.
        """
        try:
            found = path.stat()
            with path.open("rb") as file:
                first = file.read(_SIZE_OF_ENDS)
                file.seek(max(0, found.st_size - _SIZE_OF_ENDS))
                last = file.read(_SIZE_OF_ENDS)
        except OSError as error:
            reason = error.strerror or type(error).__name__
            raise ReadError(f"Cannot read '{path}': {reason}.", path=path) from error
        ends = hashlib.blake2b(first + last, digest_size=16).hexdigest()
        return cls(str(path.absolute()), found.st_size, found.st_mtime_ns, ends)

    def require_same(self) -> None:
        """Refuse a file that was changed since.

        Raises
        ------
        ReadError
        """
        path = Path(self.path)
        if Fingerprint.take(path) != self:
            raise ReadError(
                f"'{path}' was changed while it was read: run it again with the option `restart`.",
                path=path,
            )


FINAL = "is_final"
"""Value of a task that failed: whether it will each time, by the points and the options alone."""


@dataclass(frozen=True)
class Record:
    """What became of a task.

    Attributes
    ----------
    key : str
        Of the task.
    state : {"done", "empty", "failed"}
    sentence : str
        Why it failed.
    seconds : float
    points : int
        That it had to do with.
    values : mapping
        What it found, plain values.
    files : mapping of str to str
        What it wrote into the folder, with the hash of each file.
    warnings : sequence of str
        Of what is lost, for the caller.
    """

    key: str
    state: str
    sentence: str = ""
    seconds: float = 0.0
    points: int = 0
    values: Mapping[str, Any] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)
    warnings: Sequence[str] = ()


class Run:
    """The folder of a run.

    Parameters
    ----------
    folder : Path
        Beside the output.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @property
    def manifest(self) -> dict[str, Any] | None:
        """What the run computes, and from what; None where it was not begun."""
        try:
            text = (self.folder / _MANIFEST).read_text(encoding="utf-8")
        except (FileNotFoundError, NotADirectoryError):
            return None
        except OSError as error:
            raise ReadError(
                f"Cannot read the run in '{self.folder}': {error.strerror}.", path=self.folder
            ) from error
        try:
            found: dict[str, Any] = json.loads(text)
        except ValueError as error:
            raise ReadError(
                f"The run in '{self.folder}' is damaged: remove the folder.", path=self.folder
            ) from error
        return found

    @contextmanager
    def opened(self, manifest: dict[str, Any], *, restart: bool) -> Iterator[bool]:
        """Begin a run, or go on with one; yield whether it goes on.

        Raises
        ------
        WriteError
            If the folder cannot be written, holds something else, or another process is at work
            there.
        ReadError
            If it holds a run with other options or of other inputs, and may not be begun again.
        """
        found = self.manifest
        if found is None and self._holds_others():
            raise WriteError(
                f"Cannot write the run to '{self.folder}': it holds something else.",
                path=self.folder,
            )
        with self._locked():
            if found is not None and not restart:
                _require_same(found, manifest, self.folder)
            else:
                self._clear()
                self._write(_MANIFEST, manifest)
            yield found is not None and not restart

    def _holds_others(self) -> bool:
        """Whether there is more in the folder than what a run begins with, or it is a file."""
        if not self.folder.exists():
            return False
        if not self.folder.is_dir():
            return True
        begun = {self.folder / _LOCK, *find_leftovers(self.folder / _MANIFEST)}
        return any(one not in begun for one in self.folder.iterdir())

    @contextmanager
    def refused(self) -> Iterator[None]:
        """Remove the folder where no further call with the same options can go on.

        That is where they are refused, or the inputs are: not where tasks failed, files cannot be
        written, or a library is missing.
        """
        try:
            yield
        except (UnfinishedError, WriteError, MissingExtraError):
            raise
        except TinsmithError:
            self.remove()
            raise

    def remove(self) -> None:
        """Remove the folder, when what it was for is written."""
        with suppress(OSError):
            self._clear()
        shutil.rmtree(self.folder, ignore_errors=True)

    def clear_beside(self, output: Path) -> None:
        """Remove what this run left beside its output, if it was killed while it wrote it.

        What was there before it first began to write is not its own, and stays.
        """
        there = find_leftovers(output)
        try:
            before = json.loads((self.folder / _BESIDE).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            self._write(_BESIDE, [one.name for one in there])
            return
        for one in there:
            if one.name not in before:
                with suppress(OSError):
                    if one.is_dir() and not one.is_symlink():
                        shutil.rmtree(one)
                    else:
                        one.unlink()

    def _clear(self) -> None:
        """Empty the folder but for the lock.

        Killed at any moment, it is that of a run still, with fewer records than before.
        """
        _empty(self.folder, keep=_LOCK)

    @contextmanager
    def _locked(self) -> Iterator[None]:
        """Hold the folder, so that two processes never work in it."""
        lock = self.folder / _LOCK
        own = f"{os.getpid()} {socket.gethostname()}"
        try:
            self.folder.mkdir(exist_ok=True)
            if lock.exists() and not _is_held(lock):
                lock.unlink()
            descriptor = os.open(lock, os.O_CREAT | os.O_EXCL | os.O_WRONLY)
        except FileExistsError as error:
            raise WriteError(
                f"Another process works on the run in '{self.folder}': wait until it has ended, "
                f"or remove '{lock}' if there is none.",
                path=self.folder,
            ) from error
        except OSError as error:
            reason = error.strerror or type(error).__name__
            raise WriteError(
                f"Cannot write the run to '{self.folder}': {reason}.", path=self.folder
            ) from error
        try:
            os.write(descriptor, own.encode())
            os.close(descriptor)
            yield
        finally:
            lock.unlink(missing_ok=True)

    # ------------------------------------------------------------------- records

    def add(self, phase: str, record: Record) -> None:
        """Write what became of a task; called by the task, when all that it writes is there."""
        folder = self.folder / phase
        folder.mkdir(exist_ok=True)
        kept = replace(record, warnings=tuple(list_collected()))
        self._write(f"{phase}/{record.key}.json", asdict(kept))

    def read(self, phase: str) -> dict[str, Record]:
        """Return the records of a phase by their keys, without those whose files are not whole."""
        found = {}
        for path in sorted((self.folder / phase).glob("*.json")):
            try:
                values = json.loads(path.read_text(encoding="utf-8"))
                record = Record(**{**values, "warnings": tuple(values["warnings"])})
            except (OSError, ValueError, TypeError, KeyError):
                continue
            if all(hash_file(self.folder / name) == value for name, value in record.files.items()):
                found[record.key] = record
        return found

    def _write(self, name: str, values: Mapping[str, Any] | list[str]) -> None:
        with replacing(self.folder / name, binary=False) as file:
            json.dump(values, file, indent=1)


def _empty(folder: Path, *, keep: str = "") -> None:
    """Remove what a folder holds: records first, then what they refer to, the manifest last."""
    places = sorted(
        folder.iterdir(), key=lambda one: (one.name == _MANIFEST, not one.is_dir(), one.name)
    )
    for one in places:
        if one.is_dir() and not one.is_symlink():
            _empty(one)
            one.rmdir()
        elif one.name != keep:
            one.unlink()


def hash_file(path: Path) -> str:
    """Return a hash of what a file holds; empty if there is none."""
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, lambda: hashlib.blake2b(digest_size=16)).hexdigest()
    except OSError:
        return ""


def _is_held(lock: Path) -> bool:
    """Whether the process that made a lock may be at work."""
    try:
        process, _, host = lock.read_text(encoding="utf-8").partition(" ")
    except OSError:
        return True
    if host != socket.gethostname() or not process.isdecimal():
        return host != ""
    if os.name != "posix":  # where signals are none that can be asked with
        return True
    try:
        os.kill(int(process), 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        return True
    return True


def _require_same(found: Mapping[str, Any], wanted: Mapping[str, Any], folder: Path) -> None:
    """Refuse to go on with a run that computes something else, or from something else."""
    differences = list(_list_differences(found, json.loads(json.dumps(wanted))))
    if not differences:
        return
    more = f" and {counted(len(differences) - _SHOWN, 'more')}" if len(differences) > _SHOWN else ""
    raise ReadError(
        f"The run in '{folder}' was begun otherwise: {'; '.join(differences[:_SHOWN])}{more}. The "
        "option `restart` begins anew.",
        path=folder,
    )


def _list_differences(found: Mapping[str, Any], wanted: Mapping[str, Any]) -> Iterator[str]:
    if found.get("version") != wanted["version"]:
        yield f"by version {found.get('version')}, and this is {wanted['version']}"
    if found.get("product") != wanted["product"]:
        yield f"it makes {found.get('product')}, and not {wanted['product']}"
    old, new = found.get("options", {}), wanted["options"]
    for name in sorted({*old, *new}):
        if old.get(name) != new.get(name):
            yield f"`{name}` was {old.get(name)!r}, and is {new.get(name)!r}"
    yield from _list_changed(found.get("inputs", []), wanted["inputs"])
    if found.get("others") != wanted.get("others"):
        yield "the other surface has changed"


def _list_changed(old: Sequence[Mapping[str, Any]], new: Sequence[Mapping[str, Any]]) -> list[str]:
    before, now = ({one["path"]: one for one in many} for many in (old, new))
    gone = [f"'{path}' is not read any more" for path in before if path not in now]
    come = [f"'{path}' is new" for path in now if path not in before]
    kept = [path for path in now if path in before]
    changed = [f"'{path}' has changed" for path in kept if before[path] != now[path]]
    if not (gone or come or changed) and list(before) != list(now):
        changed = ["the inputs have another order"]
    return gone + come + changed
