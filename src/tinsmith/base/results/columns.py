"""Named columns and their units, none of which can be changed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Generic, TypeAlias, TypeVar

import numpy as np

from ..crs import Unit
from ..errors import OptionError
from ..lazy import make_html_repr
from ..notes import join_notes
from ..types import Frozen, seal

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Self

    from ..arrays import AnyArray

Units: TypeAlias = "Mapping[str, Unit | str | None]"
Value = TypeVar("Value")

UNKNOWN_UNIT = "unknown"
"""How a unit that is not known is written."""

_NUMBERS = "biuf"


class Noted(Frozen):
    """Base of results, which have notes."""

    notes: Sequence[str]

    def with_notes(self, notes: Sequence[str]) -> Self:
        """Return the same with further notes in front of its own, each once.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.Features.of_points([[0, 0]]).with_notes(["One row was left out."]).notes
        ('One row was left out.',)
        """
        joined = join_notes(notes, self.notes)
        return self if joined == self.notes else replace(self, notes=joined)  # type: ignore[type-var]

    def _repr_html_(self) -> str:
        return make_html_repr(self)


class FrozenMapping(Mapping[str, Value], Generic[Value]):
    """A dictionary that cannot be changed, nor can its arrays, and that can be pickled."""

    __slots__ = ("_items",)

    def __init__(self, items: Mapping[str, Value]) -> None:
        self._items = dict(items)
        for value in self._items.values():  # arrays that come from a pickle can be written to
            if isinstance(value, np.ndarray):
                seal(value)

    def __getitem__(self, name: str) -> Value:
        return self._items[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __reduce__(self) -> tuple[Any, ...]:
        return FrozenMapping, (self._items,)

    def __repr__(self) -> str:
        return repr(self._items)


def frozen_copy(values: AnyArray) -> AnyArray:
    """Return an array as it is if it is read-only already, else a read-only copy."""
    return seal(np.array(values)) if values.flags.writeable else values


def as_columns(columns: Any, count: int | None, what: str) -> FrozenMapping[AnyArray]:
    """Return named columns of equal length: of numbers, truth values or texts (None for no text).

    The length is ``count``, or else that of the first; ``what`` is what a row is: "feature", "row".
    Raises OptionError if a name is empty, lengths differ, or values are of another kind.
    """
    items = named_items("columns", columns)
    arrays = {name: _as_column(name, values) for name, values in items}
    expected = count
    for name, array in arrays.items():
        expected = len(array) if expected is None else expected
        if len(array) != expected:
            allowed = f"{expected:,}, one value for each {what}"
            raise OptionError(f"length of column '{name}'", len(array), allowed=allowed)
    return FrozenMapping(arrays)


def named_items(option: str, mapping: Any) -> list[tuple[str, Any]]:
    """Return the items of a mapping whose keys are names."""
    if mapping is None:
        return []
    if not isinstance(mapping, Mapping):
        raise OptionError(option, mapping, allowed="a mapping of names to values")
    items = list(mapping.items())
    for name, _ in items:
        if not (isinstance(name, str) and name.strip() and name.isprintable()):
            raise OptionError(f"name among {option}", name, allowed="a printable text")
    return [(str(name), value) for name, value in items]


def _as_column(name: str, values: Any) -> AnyArray:
    array = np.asarray(values)
    if array.dtype.kind == "T":
        array = array.astype(object)
    if array.ndim != 1:
        raise OptionError(f"shape of column '{name}'", array.shape, allowed="(n,), one dimension")
    if array.dtype.kind == "O":
        return _as_texts(name, array)
    if array.dtype.kind not in _NUMBERS + "U":
        kind = str(array.dtype)
        raise OptionError(
            f"type of column '{name}'", kind, allowed="one of numbers, truth values or texts"
        )
    return frozen_copy(array)


def _as_texts(name: str, array: AnyArray) -> AnyArray:
    """Return a column of objects, all of them texts or None."""
    texts = np.array([None if _is_missing(value) else value for value in array] or [], object)
    for row, value in enumerate(texts):
        if not (value is None or isinstance(value, str)):
            raise OptionError(
                f"value in row {row} of column '{name}'",
                value,
                allowed="a text or None, where numbers and texts are not mixed",
            )
    return seal(texts)


def _is_missing(value: Any) -> bool:
    return value is None or (isinstance(value, float) and value != value)


def as_units(units: Any, names: Iterable[str]) -> FrozenMapping[Unit | str | None]:
    """Return the units of columns: None for one that is not known; those not named have no unit.

    Raises OptionError if there is no such column, or a unit is neither Unit, text nor None.
    """
    known = list(names)
    items = dict(named_items("units", units))
    for name, unit in items.items():
        if name not in known:
            listed = ", ".join(f"'{one}'" for one in known) or "none, as there are no columns"
            raise OptionError("column with a unit", name, allowed=f"one of {listed}")
        is_text = isinstance(unit, str) and unit.strip() and unit.isprintable()
        if not (unit is None or isinstance(unit, Unit) or is_text):
            allowed = "a Unit, the symbol of one, or None if it is not known"
            raise OptionError(f"unit of '{name}'", unit, allowed=allowed)
    return FrozenMapping(items)


def unit_text(units: Units, name: str) -> str:
    """Return the symbol of a column's unit as it is written: "" for none, "unknown".

    Examples
    --------
    >>> from tinsmith import Unit
    >>> units = {"elevation": Unit.of("US survey foot"), "depth": None}
    >>> unit_text(units, "elevation"), unit_text(units, "depth"), unit_text(units, "id")
    ('US ft', 'unknown', '')
    """
    if name not in units:
        return ""
    unit = units[name]
    if isinstance(unit, Unit):
        return unit.symbol or unit.name
    return UNKNOWN_UNIT if unit is None else unit


def as_name(name: Any) -> str:
    """Return the name of a product."""
    if not (isinstance(name, str) and name.isprintable()):
        raise OptionError("name", name, allowed="a printable text")
    return str(name)
