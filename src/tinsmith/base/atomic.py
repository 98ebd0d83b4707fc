"""Whole files or none: write beside the target, then rename."""

from __future__ import annotations

import os
import re
import shutil
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, Literal, overload

from .errors import OptionError, TinsmithError, WriteError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from contextlib import AbstractContextManager

_SCRATCH = "tinsmith-"
_FULL = 1 << 20
"""Bytes below which a disk is full: libraries write blocks of some hundred thousand."""
_STEM = 40
"""Letters of a name that the name of the file beside it begins with: names have 255 bytes."""


def as_path(path: Any, option: str = "path") -> Path:
    """Return the path of a file, or refuse what is none."""
    if not isinstance(path, str | os.PathLike) or isinstance(os.fspath(path), bytes):
        raise OptionError(option, path, f"the name of a file, as text or Path{_find_hint(path)}")
    try:
        os.fsencode(path)
    except UnicodeEncodeError:
        allowed = "a name that can be written in the encoding of file names"
        raise OptionError(option, ascii(os.fspath(path)), allowed) from None
    return Path(path)


def _find_hint(given: Any) -> str:
    """Return what else may be meant, for a sentence."""
    if isinstance(given, bytes | bytearray | memoryview):
        return "; io.BytesIO makes a file object of what a file holds"
    if hasattr(given, "dims") or (hasattr(given, "transform") and hasattr(given, "shape")):
        return "; tinsmith.from_raster takes rasters of other libraries"
    return ""


@overload
def replacing(path: Path, *, binary: Literal[True] = True) -> AbstractContextManager[IO[bytes]]: ...
@overload
def replacing(path: Path, *, binary: Literal[False]) -> AbstractContextManager[IO[str]]: ...
@contextmanager  # type: ignore[misc]
def replacing(path: Path, *, binary: bool = True) -> Iterator[IO[bytes] | IO[str]]:
    r"""Open a file that takes the place of ``path`` when the block ends without an error.

    It is of bytes, or else of UTF-8 text whose line ends are written as given (``"\n"``). If the
    file cannot be written (no such folder, no permission, disk full) a WriteError is raised, and
    the file that was at ``path`` is as it was.
    """
    with replacing_path(path) as beside:
        if binary:
            with beside.open("wb") as raw:
                yield raw
        else:
            with beside.open("w", encoding="utf-8", newline="") as text:
                yield text


@contextmanager
def replacing_path(path: Path) -> Iterator[Path]:
    """Yield the path of an empty file beside ``path``, same suffix, for libraries that open files.

    It takes the place of ``path`` when the block ends without an error, and is removed otherwise;
    raises as :func:`replacing`.
    """
    with _finding_target(path) as target:
        beside = _name_beside(target, target.suffix)
        try:  # begins before the file is there, so that no signal can come in between
            descriptor = os.open(beside, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666)
            os.close(descriptor)
            if target.exists():  # whose permissions it gets
                beside.chmod(target.stat().st_mode & 0o777)
            with _naming_full_disks(path, target):
                yield beside
                beside.replace(target)
        finally:
            beside.unlink(missing_ok=True)


def require_writable(path: Path) -> None:
    """Raise a WriteError, before any work is done, if no file can be written at ``path``.

    That is where there is no such folder, or it may not be written to, or where a folder, a device
    or a read-only file is.
    """
    with _finding_target(path) as target:
        if not os.access(target.parent, os.W_OK | os.X_OK):
            raise _refuse(path, f"the folder '{path.parent}' may not be written to")


def _refuse(path: Path, why: str) -> WriteError:
    return WriteError(f"Cannot write '{path}': {why}.", path=path)


@contextmanager
def _finding_target(path: Path) -> Iterator[Path]:
    """Yield the file that is replaced, behind links, if it may be; faults become sentences."""
    with _translate_faults(path):
        target = _find_target(path)
        if target.is_dir():
            raise _refuse(path, "it is a folder; name a file in it")
        _require_parent(path, target)
        if target.exists() and not target.is_file():
            raise _refuse(path, "it is a device or a pipe; name an ordinary file")
        if target.exists() and not os.access(target, os.W_OK):
            raise _refuse(path, "the file there is read-only")
        yield target


_CUT_SHORT = " written"
"""What NumPy says, without the system's reason: "2028 requested and 709 written"."""


@contextmanager
def _translate_faults(path: Path) -> Iterator[None]:
    """Turn what the system says into a sentence."""
    try:
        yield
    except TinsmithError:
        raise
    except OSError as error:
        reason = error.strerror or str(error) or type(error).__name__
        if reason.endswith(_CUT_SHORT):
            reason = "the disk is full, or files may not be so large"
        raise _refuse(path, reason) from error


@contextmanager
def _naming_full_disks(path: Path, target: Path) -> Iterator[None]:
    """Name a full disk as the cause of a failure, which libraries tell in words of their own.

    Looked at before what was written is removed again.
    """
    try:
        yield
    except (WriteError, OSError, RuntimeError) as error:
        if shutil.disk_usage(target.parent).free < _FULL:
            raise _refuse(path, "no space is left on the disk") from error
        raise


def _find_target(path: Path) -> Path:
    """Follow links, so that the file itself is replaced and not the link to it."""
    try:
        return Path(os.path.realpath(path))
    except ValueError as error:
        raise WriteError(f"Cannot write {str(path)!r}: {error}.", path=path) from error


def _require_parent(path: Path, target: Path) -> None:
    if not target.parent.is_dir():
        raise _refuse(path, f"there is no folder '{path.parent}'; create it first")


def _name_beside(target: Path, suffix: str = "") -> Path:
    return target.with_name(f".{target.stem[:_STEM]}-{os.urandom(4).hex()}{suffix}")


def find_leftovers(path: Path) -> list[Path]:
    """Return what writing a file has left beside it, if it was ended before it could clear up.

    They cannot be told from the files of a writer that is at work.
    """
    stem = path.stem[:_STEM]
    left = re.compile(rf"\.+{re.escape(stem)}(?:-[0-9a-f]{{8}})+(?:\..*)?")
    try:
        return sorted(one for one in path.parent.iterdir() if left.fullmatch(one.name))
    except OSError:
        return []


@contextmanager
def scratch_folder() -> Iterator[Path]:
    """Yield a new folder among the system's temporary files, which is removed at the end."""
    with tempfile.TemporaryDirectory(prefix=f"{_SCRATCH}{os.getpid()}-") as folder:
        yield Path(folder)


def find_dead_scratch() -> list[Path]:
    """Return temporary folders of processes on this machine that were killed."""
    if os.name != "posix":
        return []
    named = re.compile(rf"{_SCRATCH}(\d+)-\w+")
    folder = Path(tempfile.gettempdir())
    try:
        found = [(one, named.fullmatch(one.name)) for one in sorted(folder.iterdir())]
    except OSError:
        return []
    return [one for one, match in found if match and not _is_running(int(match[1]))]


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True


@contextmanager
def folder_beside(path: Path) -> Iterator[Path]:
    """Yield a new hidden folder beside a file, which is removed at the end."""
    folder = _name_beside(path)
    try:  # begins before the folder is there, so that no signal can come in between
        folder.mkdir()
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def make_folder(path: Path) -> None:
    """Make a folder if there is none; a WriteError is raised where that cannot be."""
    with _translate_faults(path):
        target = _find_target(path)
        _require_parent(path, target)
        if target.exists() and not target.is_dir():
            raise _refuse(path, "a file is there, and a folder is written")
        target.mkdir(exist_ok=True)


@contextmanager
def replacing_files(path: Path, *, parts: Sequence[str] = ()) -> Iterator[Path]:
    """Yield a path of the same name in a new folder, for libraries that write several files.

    All files in that folder, which is beside ``path``, take their places when the block ends
    without an error, that of ``path`` last; raises as :func:`replacing`. ``parts`` are what the
    names of files that belong to it end with instead of its suffix (``".shx"``), or after it
    (``".tif.ovr"``): those of an earlier file, which do not belong to the new one, are removed.
    """
    with (
        _finding_target(path) as target,
        folder_beside(target) as folder,
        _naming_full_disks(path, target),
    ):
        yield folder / target.name
        made = sorted(folder.iterdir(), key=lambda one: one.name == target.name)
        if target.exists():
            (folder / target.name).chmod(target.stat().st_mode & 0o777)
        stale = {target.with_name(target.stem + part) for part in parts}
        for one in stale - {target.with_name(one.name) for one in made}:
            one.unlink(missing_ok=True)
        for one in made:
            one.replace(target.with_name(one.name))


@contextmanager
def replacing_folder(path: Path, *, marker: str) -> Iterator[Path]:
    """Yield a new folder that takes the place of ``path`` when the block ends without an error.

    A folder that is there must be empty or hold a file ``marker``, which tells that this program's
    kind of writer wrote it: of another one nothing is touched, and a WriteError is raised.
    """
    with _translate_faults(path):
        target = _find_folder(path, marker)
        fresh, old = _name_beside(target), _name_beside(target)
        try:
            fresh.mkdir()
            yield fresh
            if target.exists():
                target.rename(old)
            try:
                fresh.rename(target)
            except OSError:
                if old.exists():
                    old.rename(target)
                raise
        finally:
            shutil.rmtree(fresh, ignore_errors=True)
            shutil.rmtree(old, ignore_errors=True)


def require_writable_folder(path: Path, *, marker: str) -> None:
    """Raise a WriteError, before any work is done, where :func:`replacing_folder` would."""
    with _translate_faults(path):
        target = _find_folder(path, marker)
        if not os.access(target.parent, os.W_OK | os.X_OK):
            raise _refuse(path, f"the folder '{path.parent}' may not be written to")


def _find_folder(path: Path, marker: str) -> Path:
    """Return the folder that is replaced, if it may be."""
    target = _find_target(path)
    _require_parent(path, target)
    if target.exists() and not target.is_dir():
        raise _refuse(path, "a file is there, and a folder is written")
    if target.is_dir() and any(target.iterdir()) and not (target / marker).is_file():
        found = f"the folder is not empty, and holds no {marker} of an earlier one"
        raise _refuse(path, f"{found}; name a new folder")
    return target
