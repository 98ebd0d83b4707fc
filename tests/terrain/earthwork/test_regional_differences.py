"""Differences in regions: zones, map and sums are those of the table of volumes."""

import numpy as np
import pytest
import shapely

import tinsmith as ts

OVERLAPPING = {
    "a": [[10, 10], [50, 20], [40, 60]],
    "b": [[30, 30], [90, 30], [90, 90], [30, 90]],
    "far": [[1000, 0], [1001, 0], [1001, 1]],
}
APART = {"a": [[10, 10], [30, 10], [30, 40]], "b": [[30, 10], [60, 10], [60, 40], [30, 40]]}


def rough(count, seed):
    rng = np.random.default_rng(seed)
    xy = np.concatenate([rng.uniform(0, 100, (count, 2)), [[0, 0], [100, 0], [0, 100], [100, 100]]])
    return ts.triangulate(
        np.column_stack([xy, 5 + np.sin(xy[:, 0] / 9) + rng.uniform(0, 1, len(xy))])
    )


BASES = [{"other": rough(150, 2)}, {"base": 5.8}, {"base": [[0, 0, 5], [100, 0, 6], [0, 100, 7]]}]


@pytest.mark.parametrize("regions", [APART, OVERLAPPING, {"a": APART["a"]}])
@pytest.mark.parametrize("against", BASES)
def test_zones_add_up_to_the_table_region_by_region(regions, against):
    ground = rough(200, 1)
    found = ts.difference(ground, **against, regions=regions)
    table = ts.volume(ground, **against, regions=regions)
    for name in table.columns:
        assert found.volumes[name].tolist() == table[name].tolist() or name in (
            "lowest",
            "highest",
            "mean",
        )
    columns = found.zones.columns
    for row, region in enumerate(table["region"]):
        for kind in ("cut", "fill"):
            own = (columns["region"] == region) & (columns["kind"] == kind)
            assert columns["volume"][own].sum() == pytest.approx(
                table[kind][row], rel=1e-9, abs=1e-9
            )
            assert columns["area"][own].sum() == pytest.approx(
                table[f"{kind}_area"][row], rel=1e-9, abs=1e-9
            )


@pytest.mark.parametrize("regions", [APART, OVERLAPPING])
def test_the_tin_covers_what_is_in_any_region_once(regions):
    ground = rough(200, 1)
    found = ts.difference(ground, rough(150, 2), regions=regions)
    square = shapely.box(0, 0, 100, 100)
    union = shapely.union_all([shapely.Polygon(ring) for ring in regions.values()])
    assert found.tin.area == pytest.approx(union.intersection(square).area, rel=1e-12)
    assert found.statistics["area"][0] == pytest.approx(found.tin.area, rel=1e-12)
    assert ts.check(found.tin).ok
    for one in found.zones.to_shapely():
        assert union.buffer(1e-9).covers(one)


def test_zones_end_at_the_border_of_each_region():
    found = ts.difference(rough(200, 1), base=0.0, regions=APART)
    shapes = dict(zip(found.zones.columns["region"], found.zones.to_shapely(), strict=True))
    for name, ring in APART.items():
        assert shapes[name].equals_exact(shapely.Polygon(ring), 1e-9, normalize=True) or (
            shapes[name].symmetric_difference(shapely.Polygon(ring)).area < 1e-9
        )


@pytest.mark.parametrize("regions", [None, APART, OVERLAPPING])
def test_the_words_of_the_map_are_the_sums_of_the_table(regions):
    ground, design = rough(200, 1), rough(150, 2)
    table = ts.volume(ground, design, regions=regions)
    figure = ts.earthwork_map(ts.difference(ground, design, regions=regions))
    caption = figure.axes[0].get_title(loc="left").replace(",", "").lower()
    for kind in ("cut", "fill"):
        volume, area = (float(table[name].sum()) for name in (kind, f"{kind}_area"))
        told = caption.split(f"{kind} ", 1)[1].split(" over ")
        assert float(told[0]) == pytest.approx(volume, rel=1e-3)
        assert float(told[1].split(";")[0]) == pytest.approx(area, rel=1e-3)


def test_regions_beside_both_surfaces_are_refused():
    with pytest.raises(ts.base.errors.PointsError, match="hold nothing"):
        ts.difference(rough(50, 1), base=5.0, regions={"far": OVERLAPPING["far"]})


@pytest.mark.parametrize("given", [{}, {"other": rough(20, 3), "base": 1.0}])
def test_one_base_is_needed(given):
    with pytest.raises(ts.base.errors.OptionError, match="base"):
        ts.difference(rough(20, 1), **given)
