"""Table: named columns with units."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from .. import optional
from ..errors import OptionError
from ..notes import as_notes
from ..sentences import counted
from .columns import Noted, as_columns, as_name, as_units, unit_text

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import pandas as pd

    from ..arrays import AnyArray
    from .columns import Units
    from .features import Features


@dataclass(frozen=True, eq=False, repr=False)
class Table(Noted):
    """Named columns of equal length, with units.

    Attributes
    ----------
    columns : mapping of str to (n,) array
        Numbers, truth values or texts (None where there is none).
    units : mapping of str to Unit, str or None
        A unit or its symbol, None if it is not known; a column without an entry has no unit.
    name, notes
        As of :class:`tinsmith.Features`.

    Raises
    ------
    OptionError
        If there is no column, lengths differ, or a unit or name is none.

    Examples
    --------
    >>> import tinsmith as ts
    >>> table = ts.Table({"level": [318.0, 319.0], "volume": [0.0, 52.5]}, units={"volume": "m³"})
    >>> table
    <Table: 2 rows, columns level, volume>
    >>> table["volume"]
    array([ 0. , 52.5])
    """

    columns: Mapping[str, AnyArray]
    units: Units = field(default_factory=dict, kw_only=True)
    name: str = field(default="", kw_only=True)
    notes: Sequence[str] = field(default=(), kw_only=True)

    def __post_init__(self) -> None:
        keep = object.__setattr__
        keep(self, "columns", as_columns(self.columns, None, "row"))
        if not self.columns:
            raise OptionError("columns", 0, allowed="1 or more", what="number of columns")
        keep(self, "units", as_units(self.units, self.columns))
        keep(self, "name", as_name(self.name))
        keep(self, "notes", as_notes(self.notes))

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def __getitem__(self, name: str) -> AnyArray:
        return self.columns[name]

    def to_dataframe(self) -> pd.DataFrame:
        """Return a data frame; its ``attrs`` have ``name``, ``units`` and ``notes``.

        Returns
        -------
        pandas.DataFrame

        Raises
        ------
        MissingExtraError
            If pandas is not installed.

        Examples
        --------
        >>> import tinsmith as ts
        >>> frame = ts.Table({"level": [318.0]}, units={"level": "m"}).to_dataframe()
        >>> frame.attrs["units"]
        {'level': 'm'}
        """
        pandas = optional.load("pandas", "Turning a table into a DataFrame")
        frame: pd.DataFrame = pandas.DataFrame(
            {name: values.copy() for name, values in self.columns.items()}
        )
        units = {name: unit_text(self.units, name) for name in self.units}
        frame.attrs |= {"name": self.name, "units": units, "notes": list(self.notes)}
        return frame

    def __repr__(self) -> str:
        title = f" {self.name}" if self.name else ""
        return f"<Table{title}: {counted(len(self), 'row')}, columns {', '.join(self.columns)}>"


def tabulate_columns(features: Features) -> Table:
    """Return the columns of features as a table, without their geometries."""
    return Table(
        dict(features.columns), units=dict(features.units), name=features.name, notes=features.notes
    )
