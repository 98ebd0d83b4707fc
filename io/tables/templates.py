"""Read templates and superelevation of corridors: tables as text (CSV) or JSON."""

from __future__ import annotations

import json
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from ...base.atomic import as_path
from ...base.errors import OptionError, ReadError
from ...base.notes import naming_file
from ...base.sentences import FILE
from ...terrain import Template
from ..delimited import read_text_table
from ..isolated import as_local_file

if TYPE_CHECKING:
    import os
    from pathlib import Path

    from ...base.arrays import Float64Array

_TURNS = ("station", "left", "right")


def read_template(path: str | os.PathLike[str] | IO[Any]) -> Template | dict[float, Template]:
    r"""Read the template of a corridor, or templates by station, from a table.

    Parameters
    ----------
    path : path-like or file object
        A text file (CSV) whose first line names the columns, or JSON with a list of objects. A row
        for each part, from the axis outwards, with the columns of
        :meth:`tinsmith.Template.from_table`; with a ``station`` it belongs to the template of that
        station, and without one to those of all stations.

    Returns
    -------
    Template or dict of float to Template
        By their stations, CRS units, if rows have one.

    Raises
    ------
    ReadError
        If the file is missing, or its rows are no template.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> rows = ["side,name,width,slope,use,ratio", "both,lane,3.5,-0.025,turns,"]
    >>> rows += ["both,,,,cut,1.5", "both,,,,fill,2"]
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "road.csv")
    ...     _ = file.write_text("\n".join(rows), encoding="utf-8")
    ...     ts.read_template(file).left.width
    3.5
    """
    with as_local_file(path) as place, naming_file(as_path(place)):
        rows = _read_rows(as_path(place))
        try:
            return Template.by_station(rows) or Template.from_table(rows)
        except OptionError as error:
            raise ReadError(f"{FILE} is no template. {error}") from error


def read_superelevation(path: str | os.PathLike[str] | IO[Any]) -> Float64Array:
    r"""Read superelevation by station from a table, for :func:`tinsmith.corridor`.

    Parameters
    ----------
    path : path-like or file object
        A text file (CSV) whose first line names the columns, or JSON with a list of objects. Each
        row has a ``station``, and the slopes ``left`` and ``right``: rise outwards over width.

    Returns
    -------
    (k, 3) float64 array
        Station, CRS units, slope of the left and of the right side.

    Raises
    ------
    ReadError
        If the file is missing, lacks a column, or has a cell that is no number.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> rows = ["station,left,right", "100,-0.025,-0.025", "140,0.05,-0.05"]
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "turns.csv")
    ...     _ = file.write_text("\n".join(rows), encoding="utf-8")
    ...     ts.read_superelevation(file)[:, 0]
    array([100., 140.])
    """
    with as_local_file(path) as place, naming_file(as_path(place)):
        rows = _read_rows(as_path(place))
        if not rows:
            raise ReadError(f"{FILE} has no row: superelevation needs one at least.")
        found = np.empty((len(rows), len(_TURNS)))
        for number, row in enumerate(rows, 1):
            if set(row) != set(_TURNS):
                raise ReadError(
                    f"{FILE} is no superelevation: row {number} has the columns "
                    f"{', '.join(row) or 'none'}, and {', '.join(_TURNS)} are needed."
                )
            for k, name in enumerate(_TURNS):
                found[number - 1, k] = _read_number(row[name], name, number)
        return found


def _read_number(value: Any, name: str, row: int) -> float:
    try:
        number = float("nan" if isinstance(value, bool) else value)
    except (TypeError, ValueError):
        number = np.nan
    if not np.isfinite(number):
        raise ReadError(f"{FILE} has no number in row {row} of '{name}': {value!r}.")
    return number


def _read_rows(file: Path) -> list[dict[str, Any]]:
    """Return the rows of a table by their columns. Raises ReadError."""
    if file.suffix.lower() != ".json":
        table = read_text_table(file, None)
        return [dict(zip(table.header, row, strict=True)) for row in table.rows]
    try:
        rows = json.loads(file.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise ReadError(f"Cannot read {FILE}: {error.strerror}.") from error
    except ValueError as error:  # of the decoder, or no UTF-8
        raise ReadError(f"Cannot read {FILE}: it is no JSON ({error}).") from error
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise ReadError(f"{FILE} is no list of objects, one for each row.")
    return rows
