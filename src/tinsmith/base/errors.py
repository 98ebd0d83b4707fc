"""Errors: one root, and each also the built-in that it resembles. Knows no package."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar, get_args

from .sentences import FILE, name_file, printable, shown

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from pathlib import Path

Value = TypeVar("Value")


class TinsmithError(Exception):
    """Root of every error that tinsmith raises on purpose; its text is one clear sentence.

    Attributes
    ----------
    file : Path or None
        The file that was read or written.
    """

    file: Path | None = None
    is_of_file = False
    """Whether it is what a file holds that is at fault: the sentence names the file."""

    def __str__(self) -> str:
        text = str(self.args[0]) if self.args else ""
        return text.replace(FILE, "the file")

    def add_file(self, file: Path) -> None:
        """Name the file of which the sentence speaks, unless one is named."""
        if self.file is not None or not self.args:
            return
        self.file = file
        text = str(self.args[0])
        if self.is_of_file or FILE in text:
            self.args = (printable(name_file(text, str(file))),)

    def __reduce__(self) -> tuple[Any, ...]:
        """Copy and pickle sentence and data, whatever the class is made of."""
        return _remake, (type(self), self.args), self.__dict__


def _remake(kind: type[TinsmithError], arguments: tuple[Any, ...]) -> TinsmithError:
    error = kind.__new__(kind)
    error.args = arguments
    return error


class OptionError(TinsmithError, ValueError):
    """An option outside what is allowed.

    Attributes
    ----------
    option : str
        Name of the parameter.
    value : object
        What was given.
    allowed : str or tuple of str
        What may be given instead: the words, where it is one of a few.
    what : str
        What of the option the value is, such as its number of items; empty for itself.
    or_none : bool
        Whether None may be given, too.

    Examples
    --------
    >>> print(OptionError("snap", -1, "a distance >= 0"))
    Invalid snap -1: it must be a distance >= 0.
    >>> print(OptionError("crossing", "join", ["split", "error"]))
    Invalid crossing 'join': it must be one of split, error.
    """

    def __init__(
        self,
        option: str,
        value: object,
        allowed: str | Iterable[str],
        *,
        what: str = "",
        or_none: bool = False,
    ) -> None:
        self.option = option
        self.value = value
        self.allowed = allowed if isinstance(allowed, str) else tuple(allowed)
        self.what = what
        self.or_none = or_none
        super().__init__(self.describe())

    def add_file(self, file: Path) -> None:
        """Name the file of which the sentence speaks."""
        if isinstance(self.allowed, str):
            self.allowed = self.allowed.replace(FILE, f"'{file}'")
        super().add_file(file)

    def describe(self, flag: str = "") -> str:
        """Return the sentence, with the flag of a command in place of the option's name."""
        is_text = isinstance(self.allowed, str)
        allowed = self.allowed if is_text else f"one of {', '.join(self.allowed)}"
        none = ", or None" if self.or_none and not flag else ""
        named = self.what or flag or self.option
        from_flag = f" ({flag})" if self.what and flag else ""
        return printable(
            f"Invalid {named} {shown(self.value)}: it must be {allowed}{none}.{from_flag}"
        )


def choice(option: str, value: Value, allowed: Any) -> Value:
    """Return an option that is one of the words of a Literal, or of a few, or refuse it.

    Examples
    --------
    >>> choice("crossing", "split", ("split", "error"))
    'split'
    """
    words = get_args(allowed) or tuple(allowed)
    if not (isinstance(value, str) and value in words):
        raise OptionError(option, value, words)
    return value


class CrsError(TinsmithError, ValueError):
    """A coordinate reference system that is unknown, or that does not fit the purpose.

    Attributes
    ----------
    crs : object
        What was given.
    """

    is_of_file = True

    def __init__(self, message: str, *, crs: object = None) -> None:
        super().__init__(message)
        self.crs = crs


class PointsError(TinsmithError, ValueError):
    """Points that cannot make a TIN, or vertices that it does not have.

    Attributes
    ----------
    rows : tuple of int
        The first few row numbers (0-based, in the caller's own input) at fault; may be empty.
    """

    is_of_file = True

    def __init__(self, message: str, *, rows: Iterable[int] = ()) -> None:
        super().__init__(message)
        self.rows = tuple(int(row) for row in rows)


class LinesError(TinsmithError, ValueError):
    """Breaklines, rings or water that the surface cannot hold.

    Attributes
    ----------
    lines : tuple of int
        The first few lines (0-based, in the caller's own input) at fault; may be empty.
    """

    is_of_file = True

    def __init__(self, message: str, *, lines: Iterable[int] = ()) -> None:
        super().__init__(message)
        self.lines = tuple(int(line) for line in lines)


class CheckError(TinsmithError, ValueError):
    """A TIN that is not what it should be; the text is one sentence for each kind of problem.

    Attributes
    ----------
    problems : tuple of Problem
        As in :class:`tinsmith.CheckResult`.
    """

    def __init__(self, message: str, *, problems: Sequence[Any] = ()) -> None:
        super().__init__(message)
        self.problems = tuple(problems)


class ReadError(TinsmithError, OSError, ValueError):
    """A file that cannot be read, or whose content is not what it should be.

    Attributes
    ----------
    lines : tuple of int
        The first few line numbers at fault, counted from 1 as an editor does; may be empty.
    """

    is_of_file = True

    def __init__(
        self, message: str, *, path: Path | None = None, lines: Sequence[int] = ()
    ) -> None:
        super().__init__(printable(message))
        self.file = path
        self.lines = tuple(int(line) for line in lines)

    @property
    def line(self) -> int | None:
        """The first line at fault, None if the fault is not in one line."""
        return self.lines[0] if self.lines else None


class WriteError(TinsmithError, OSError):
    """A file that cannot be written; a file that was there before is left whole."""

    is_of_file = True

    def __init__(self, message: str, *, path: Path | None = None) -> None:
        super().__init__(message)
        self.file = path


class FormatError(TinsmithError, ValueError):
    """No format fits, or the format does not have what is asked of it.

    Attributes
    ----------
    known : tuple of str
        The names, suffixes, options or values that would be accepted; may be empty.
    """

    def __init__(self, message: str, *, known: Sequence[str] = ()) -> None:
        super().__init__(printable(message))
        self.known = tuple(known)


class UnknownOptionError(FormatError):
    """A format has not the option that is given.

    Attributes
    ----------
    option : str
    action : str
        "read" or "write".
    format : str
        Name of the format.
    """

    def __init__(self, option: str, action: str, format: str, known: Sequence[str]) -> None:  # noqa: A002 - as in read
        self.option, self.action, self.format = option, action, format
        self.known = tuple(known)
        super().__init__(self.describe(), known=known)

    def describe(self, find_flag: Callable[[str], str | None] = str) -> str:
        """Return the sentence, with the flags of those options of the format that have one."""
        named = [flag for flag in map(find_flag, self.known) if flag]
        there_are = f"its options are {', '.join(named)}" if named else "it has no options"
        option = printable(find_flag(self.option) or self.option)
        return f"Unknown option {option} to {self.action} the format {self.format}: {there_are}."


class RenderError(TinsmithError, RuntimeError):
    """A picture that cannot be made or written; the sentence names the way out."""


class MissingExtraError(TinsmithError, ImportError):
    """A library is not installed; the sentence names the command that brings it.

    Attributes
    ----------
    extra : str
        Name of the extra, as in ``pip install "tinsmith[extra]"``; "" for a library that an
        ordinary installation has.
    """

    def __init__(self, library: str, *, extra: str, purpose: str) -> None:
        what = f'"tinsmith[{extra}]"' if extra else library
        super().__init__(
            f"{purpose} needs {library}, which is not installed: run pip install {what}."
        )
        self.extra = extra


class LossWarning(UserWarning):
    """A format could not hold all that was written; the text is one sentence that says what."""


class PlugInWarning(UserWarning):
    """A plug-in is left out, or a part of it; the text names its distribution and says why."""
