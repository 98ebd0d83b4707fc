"""Names of other libraries, and errors that other libraries' users catch."""

import copy
import pickle

import pytest

import tinsmith as ts
from tinsmith.base.lazy import _CALLED, _CALLED_BY_CLASS

TIN = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]])


@pytest.mark.parametrize(("name", "called"), _CALLED.items())
def test_names_of_other_libraries_lead_to_what_there_is(name, called):
    assert not hasattr(TIN, name)
    with pytest.raises(AttributeError, match=f"has no '{name}': use `"):
        getattr(TIN, name)
    eval(called.replace("tinsmith", "ts"), {"ts": ts, **{k: getattr(TIN, k) for k in dir(TIN)},
                                            "tin": TIN})  # fmt: skip


RASTER = ts.rasterize(TIN, spacing=1.0)


@pytest.mark.parametrize(("name", "called"), _CALLED_BY_CLASS["Raster"].items())
def test_names_of_rasterio_and_xarray_lead_to_what_a_raster_has(name, called):
    assert not hasattr(RASTER, name)
    with pytest.raises(AttributeError, match=f"A Raster has no '{name}': use `"):
        getattr(RASTER, name)
    own = {"ts": ts, **{k: getattr(RASTER, k) for k in dir(RASTER)}}
    eval(called.replace("tinsmith", "ts"), own)
    assert copy.deepcopy(RASTER).grid == pickle.loads(pickle.dumps(RASTER)).grid == RASTER.grid


def test_functions_and_near_names_are_named():
    with pytest.raises(AttributeError, match=r"use `tinsmith\.contours\(tin, \.\.\.\)`"):
        TIN.contours  # noqa: B018
    with pytest.raises(AttributeError, match="Did you mean 'interpolate'"):
        TIN.interpolat  # noqa: B018
    with pytest.raises(AttributeError, match="A Snapshot has no 'nothing'"):
        TIN.snapshot().nothing  # noqa: B018
    assert pickle.loads(pickle.dumps(TIN)) == TIN
    assert copy.deepcopy(TIN) == TIN


def test_a_file_that_cannot_be_read_is_an_error_of_the_system(tmp_path):
    with pytest.raises(OSError, match="There is no file"):
        ts.read(tmp_path / "none.csv")
    error = ts.ReadError("'a' is damaged.", lines=[3])
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.lines, again.file) == (str(error), (3,), None)
