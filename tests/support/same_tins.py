"""Whether two TINs are the same in all that they are, bit for bit."""

from __future__ import annotations

import numpy as np

from tinsmith.io.mesh.geopackage.records import pack_tin

ARRAYS = ("points", "triangles", "neighbors", "constrained", "vertex_of")


def find_differences(one, other):
    """Return the names of what differs: arrays, reference, lines, report, edits, inputs."""
    found = [name for name in ARRAYS if not _is_same(getattr(one, name), getattr(other, name))]
    first, second = (
        _fill(record.document, record.arrays) for record in map(pack_tin, (one, other))
    )
    return found + sorted(
        key for key in first.keys() | second.keys() if first.get(key) != second.get(key)
    )


def _is_same(one, other):
    return (one.dtype, one.shape, one.tobytes()) == (other.dtype, other.shape, other.tobytes())


def _fill(tree, arrays):
    """Return a tree with its arrays in their places."""
    if isinstance(tree, dict) and list(tree) == ["array"]:
        array = np.asarray(arrays[tree["array"]])
        return (array.dtype.str, array.shape, array.tobytes())
    if isinstance(tree, dict):
        return {key: _fill(one, arrays) for key, one in tree.items()}
    return [_fill(one, arrays) for one in tree] if isinstance(tree, list) else tree
