"""Every product of odd surfaces returns, or refuses in a sentence, and never warns of overflow."""

import warnings

import numpy as np
import pytest
from support.product_calls import ALL, HILL

import tinsmith as ts
from tinsmith.tin.predicates import LARGEST_ELEVATION

XY = HILL.points[:, :2]
SIGNS = np.where(np.arange(len(XY)) % 2, 1.0, -1.0)
LOW, HIGH = XY.min(axis=0), XY.max(axis=0)

ELEVATIONS = {
    "largest of both signs": SIGNS * LARGEST_ELEVATION,
    "all the largest": np.full(len(XY), LARGEST_ELEVATION),
    "squares near the largest": SIGNS * 1e150,
    "squares beyond the largest": SIGNS * 1e160,
    "smallest doubles": SIGNS * 5e-324,
    "level": np.zeros(len(XY)),
    "one spike": np.where(np.arange(len(XY)) == 210, LARGEST_ELEVATION, 320.0),
    "rounding": 320 + SIGNS * 1e-13,
}


def build(points, **options):
    return ts.triangulate(points, crs=HILL.crs, **options)


SURFACES = {
    **{name: lambda z=z: build(np.column_stack([XY, z])) for name, z in ELEVATIONS.items()},
    "needles": lambda: build(
        np.concatenate([HILL.points, np.add(HILL.points[:200], [1e-9, 0, 1])])
    ),
    "two triangles": lambda: build(
        [[*LOW, 320], [HIGH[0], LOW[1], 321], [*HIGH, 0], [LOW[0], HIGH[1], 5]]
    ),
    "one thin triangle": lambda: build([[*LOW, 320], [*HIGH, 321], [*(HIGH - [1, 0]), 0]]),
    "two parts": lambda: build(HILL.points[np.abs(XY[:, 0] - XY[:, 0].mean()) > 10], max_edge=9.0),
    "hole": lambda: build(
        HILL.points, holes=[(LOW + HIGH) / 2 + [[-15, -15], [15, -15], [15, 15], [-15, 15]]]
    ),
}


@pytest.fixture(scope="module", params=SURFACES)
def odd(request):
    return SURFACES[request.param]()


@pytest.mark.every_case("slow")
@pytest.mark.each_value(others="slow")
@pytest.mark.parametrize("name", ALL)
def test_products_return_or_refuse(odd, name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            found = ALL[name](odd)
        except ts.TinsmithError:
            return
    for array in np.atleast_1d(found) if isinstance(found, np.ndarray) else ():
        assert not np.isinf(array).any()
