"""A stream of points beside the whole file: the same bits, sentences and refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.io.registry import PointChunk
from tinsmith.io.streaming import stream_points

__all__ = ["CHUNKS", "gather", "require_same"]

CHUNKS = (1, 7, 1000, 10**9)


def gather(path: Any, chunk_points: int, **options: Any) -> tuple[list[PointChunk], Any]:
    """Return all chunks of a stream, and the stream."""
    with stream_points(path, chunk_points=chunk_points, **options) as stream:
        crs, unit = stream.crs, stream.elevation_unit
        chunks = list(stream)
    assert (crs, unit) == (stream.crs, stream.elevation_unit)
    return chunks, stream


def require_same(
    path: Any, *, chunks: tuple[int, ...] = CHUNKS, notes: bool = True, **options: Any
) -> Any:
    """Read a file whole and in chunks of several sizes; return the survey, or the error of both."""
    try:
        survey = ts.read_points(path, **options)
    except ts.TinsmithError as error:
        for count in chunks:
            _require_refused(path, count, error, options)
        return error
    for count in chunks:
        found, stream = gather(path, count, **options)
        _require_equal(survey, found, count)
        assert not notes or stream.notes == list(survey.notes)
        assert stream.skipped == dict(survey.skipped)
        assert stream.crs == survey.crs
        assert stream.elevation_unit == survey.elevation_unit
    return survey


def _require_refused(path: Any, count: int, error: ts.TinsmithError, options: Any) -> None:
    with pytest.raises(type(error)) as caught:
        gather(path, count, **options)
    assert str(caught.value) == str(error)
    assert type(caught.value) is type(error)


def _require_equal(survey: ts.Survey, found: list[PointChunk], count: int) -> None:
    assert [len(one) for one in found[:-1]] == [count] * (len(found) - 1)
    assert 0 < len(found[-1]) <= count
    points = np.concatenate([one.points for one in found])
    assert points.dtype == np.float64
    assert points.tobytes() == np.ascontiguousarray(survey.points).tobytes()
    rows = np.concatenate([one.rows for one in found])
    assert rows.dtype == np.int64
    assert (np.diff(rows) > 0).all()
    if survey.row_sources is not None:
        assert np.array_equal(rows, survey.row_sources.lines)
    for name, values in survey.attributes.items():
        parts = [one.attributes.get(name, np.zeros(len(one), values.dtype)) for one in found]
        _require_equal_values(np.concatenate(parts), values, name)


def _require_equal_values(found: Any, wanted: Any, name: str) -> None:
    """Require the same values, of any type; NaN is NaN."""
    if {found.dtype.kind, wanted.dtype.kind} <= set("biuf"):
        np.testing.assert_array_equal(found, wanted, err_msg=name)
    elif all(isinstance(one, float | int) for one in wanted.tolist()):
        assert found.tolist() == pytest.approx(wanted.tolist(), rel=0, abs=0, nan_ok=True), name
    else:
        assert found.tolist() == wanted.tolist(), name
