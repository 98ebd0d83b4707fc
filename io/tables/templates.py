"""Read templates of corridors: a text file with a row for each part of a cross section."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.atomic import as_path
from ...base.errors import OptionError, ReadError
from ...base.notes import naming_file
from ...base.sentences import FILE
from ...terrain import Template
from ..delimited import read_text_table

if TYPE_CHECKING:
    import os


def read_template(path: str | os.PathLike[str]) -> Template:
    r"""Read the template of a corridor from a text file (CSV) whose first line names the columns.

    Parameters
    ----------
    path : path-like
        A row for each part, from the axis outwards, with the columns of
        :meth:`tinsmith.Template.from_table`.

    Returns
    -------
    Template

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
    file = as_path(path)
    with naming_file(file):
        table = read_text_table(file, None)
        rows = [dict(zip(table.header, row, strict=True)) for row in table.rows]
        try:
            return Template.from_table(rows)
        except OptionError as error:
            raise ReadError(f"{FILE} is no template. {error}") from error
