"""Values of columns as JSON."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ....base.arrays import AnyArray


def json_texts(values: AnyArray) -> list[str]:
    """Return each value of a column as JSON; ``null`` for what is missing or not finite.

    Examples
    --------
    >>> json_texts(np.array([0.1, np.nan])), json_texts(np.array(["a", None], object))
    (['0.1', 'null'], ['"a"', 'null'])
    """
    if values.dtype.kind == "b":
        return [("false", "true")[value] for value in values.tolist()]
    if values.dtype.kind in "iu":
        return list(map(str, values.tolist()))
    if values.dtype.kind == "f":
        texts = list(map(repr, values.tolist()))
        for row in np.flatnonzero(~np.isfinite(values)).tolist():
            texts[row] = "null"
        return texts
    return [json.dumps(value) for value in values.tolist()]


def properties_template(names: list[str]) -> str:
    """Return an object of JSON with ``%s`` for each value.

    Examples
    --------
    >>> properties_template(["a", "50 %"])
    '{"a":%s,"50 %%":%s}'
    """
    return "{" + ",".join(f"{json.dumps(name).replace('%', '%%')}:%s" for name in names) + "}"
