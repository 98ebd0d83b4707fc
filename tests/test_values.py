"""Dataclasses: values that nobody changes, and arrays that are not compared by ``==``."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import pkgutil
from pathlib import Path

import pytest

import tinsmith
from tinsmith.base import arrays
from tinsmith.tin.constraints.polylines import Polylines

WORKED_ON = {
    "io.delimited.layout._Top", "io.delimited.names._Found",
    "io.field_survey.figures.Figure", "io.field_survey.geometry._Line",
    "io.field_survey.instruments.gsi._Block", "io.field_survey.instruments.records.Book",
    "io.delimited.table_reader._Head", "io.delimited.table_reader._Account",
    "io.lidar.reading._Seen", "io.vector.parquet.streaming._Missing",
    "io.lidar.selection.Tally", "io.cad.landxml.content.Content", "io.cad.landxml.content.Line",
    "io.cad.landxml.content.Points", "io.cad.landxml.content.Surface",
    "io.cad.landxml.alignment_elements.ElementReader", "io.cad.landxml.alignment_nodes.Node",
    "io.lidar.labelling.LabelledFile", "terrain.ground_filter.returns.Candidates",
    "terrain.plans.mapping.Drawn", "tin.screening.heights._Search",
}  # fmt: skip
"""Filled in step by step while a file is read, a sheet is drawn, or blunders are searched."""


def modules():
    """All modules of the installed packages but the compiled one and those of benchmarks."""
    for found in pkgutil.walk_packages(tinsmith.__path__, "tinsmith."):
        if not {"_core", "benchmarks", "__main__"} & set(found.name.split(".")):
            yield importlib.import_module(found.name)


def dataclasses_of(module):
    for one in vars(module).values():
        is_own = inspect.isclass(one) and one.__module__ == module.__name__
        if is_own and "__dataclass_params__" in vars(one):
            yield one


CLASSES = [one for module in modules() for one in dataclasses_of(module)]


@pytest.mark.parametrize("one", CLASSES, ids=lambda one: one.__name__)
def test_a_value_cannot_be_changed(one):
    place = f"{one.__module__.removeprefix('tinsmith.')}.{one.__name__}"
    is_changed = place in WORKED_ON
    assert one.__dataclass_params__.frozen != is_changed


@pytest.mark.parametrize("one", CLASSES, ids=lambda one: one.__name__)
def test_values_that_hold_arrays_are_equal_only_to_themselves(one):
    """``==`` of arrays is no truth value."""
    family = [one, *(base for base in one.__mro__[1:] if dataclasses.is_dataclass(base))]
    holds = any(_is_array(field.type) for field in dataclasses.fields(one))
    if holds or any(base.__eq__ is object.__eq__ for base in family[1:]):
        assert one.__eq__ is object.__eq__
        assert one.__hash__ is object.__hash__


ARRAYS = [name for name in vars(arrays) if name.endswith("Array")]


def _is_array(annotation):
    return any(name in str(annotation) for name in ("NDArray", *ARRAYS))


def test_values_that_hold_arrays_are_found():
    assert _is_array(Polylines.__dataclass_fields__["vertices"].type)


def test_all_dataclasses_are_seen():
    root = Path(__file__).parents[1]
    places = [root / name for name in ("tin", "io", "terrain", "src/tinsmith")]
    texts = [path.read_text() for place in places for path in place.rglob("*.py")]
    assert len(CLASSES) == sum(text.count("\n@dataclass") for text in texts)
