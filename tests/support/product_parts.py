"""Products of a surface in tiles, joined, and that they are those of the whole."""

from __future__ import annotations

import numpy as np

import tinsmith as ts
from tinsmith.terrain.earthwork.planes import as_plane
from tinsmith.terrain.earthwork.regions import as_regions
from tinsmith.terrain.isolines import LevelOptions
from tinsmith.terrain.parts import bands, contours, lines, places, rasters, volumes
from tinsmith.terrain.surface import as_segments, find_reference, measure_rounding


def require_same_bits(found, wanted, what=""):
    """Require two arrays of numbers to be the same to the last bit; NaN is NaN."""
    assert found.dtype == wanted.dtype
    assert found.shape == wanted.shape, what
    if found.dtype.kind != "f":
        np.testing.assert_array_equal(found, wanted, err_msg=what)
        return
    kind = np.dtype(f"u{found.dtype.itemsize}")
    differ = np.ascontiguousarray(found).view(kind) != np.ascontiguousarray(wanted).view(kind)
    differ &= ~(np.isnan(found) & np.isnan(wanted))
    assert not differ.any(), f"{what}: {differ.sum()} differ, first at {np.argwhere(differ)[0]}"


def require_same_features(found, wanted):
    """Require the same coordinates, parts and columns, in the same order."""
    require_same_bits(found.coordinates, wanted.coordinates, "coordinates")
    assert len(found.offsets) == len(wanted.offsets)
    for one, other in zip(found.offsets, wanted.offsets, strict=True):
        np.testing.assert_array_equal(one, other)
    require_same_table(found.columns, wanted.columns)


def require_same_table(found, wanted):
    """Require the same columns."""
    found, wanted = (dict(getattr(one, "columns", one)) for one in (found, wanted))
    assert list(found) == list(wanted)
    for name in wanted:
        require_same_bits(np.asarray(found[name]), np.asarray(wanted[name]), name)


def make_grid(points, cells):
    """Return a grid some of whose cells lie off the surface."""
    bounds = ts.Bounds.of(points)
    spacing = max(bounds.width, bounds.height) / cells
    rows, columns = (int(side / spacing) + 4 for side in (bounds.height, bounds.width))
    west, north = bounds.xmin - 1.5 * spacing, bounds.ymax + 1.5 * spacing
    around = ts.Bounds(west, north - rows * spacing, west + columns * spacing, north)
    return ts.Grid(around, (rows, columns), spacing)


def join_raster(tiling, options, seed=0):
    """Return all cells."""
    blocks = tiling.compute(lambda part, box: rasters.compute_part(part, box, options), seed)
    return rasters.join(blocks, options)


def list_contour_parts(tiling, points, given, seed=0):
    """Return options and the contours in each tile; ``given`` has an interval or levels."""
    z = points[:, 2]
    chosen = LevelOptions(given.get("interval"), given.get("levels"), 0.0, 5)
    options = contours.ContourOptions(chosen.for_lines_between(z.min() - 1.0, z.max() + 1.0))
    return options, tiling.compute(
        lambda part, box: contours.compute_part(part, box, options), seed
    )


def join_contours(tiling, points, given, seed=0):
    """Return the lines of all tiles."""
    options, parts = list_contour_parts(tiling, points, given, seed)
    return contours.join(parts, options)


def join_bands(tiling, points, given, seed=0):
    """Return the polygons of all tiles, which are joined in another order."""
    z = points[:, 2]
    chosen = LevelOptions(given.get("interval"), given.get("levels"), 0.0)
    levels = chosen.for_bands_between(z.min() - 1.0, z.max() + 1.0)
    extent = float(np.ptp(points[:, :2], axis=0).sum())
    options = bands.BandOptions(levels, measure_rounding(points), extent)
    parts = tiling.compute(lambda part, box: bands.compute_part(part, box, options), seed)
    order = np.random.default_rng(seed + 1).permutation(len(parts))
    return bands.join([parts[k] for k in order], options)


def make_volume_options(tin, base, regions):
    """Return options of volumes to a base, or to another surface if it is None."""
    names, parts, _ = (("all",), None, ()) if regions is None else as_regions(regions, None)
    plane = None if base is None else as_plane(base)
    return volumes.VolumeOptions(find_reference(tin, "Volumes"), plane, tuple(names), parts)


def join_volumes(tiling, options, seed=0):
    """Return volumes to a plane."""
    parts = tiling.compute(lambda part, box: volumes.compute_part(part, box, options), seed)
    return volumes.join(parts, options)


def join_lines(tiling, tin, given, seed=0):
    """Return the surface along lines."""
    segments = as_segments(np.concatenate(given) + 0.0, np.cumsum([0, *map(len, given)]))
    options = lines.LineOptions(segments, tin.points[np.concatenate(tin.boundary)])
    parts = tiling.compute(lambda part, box: lines.compute_part(part, box, options), seed)
    return lines.join(parts, options)


def join_places(tiling, asked, seed=0):
    """Return elevations."""
    parts = tiling.compute(lambda part, box: places.compute_part(part, box, asked), seed)
    return places.join(parts, len(asked))


def require_parts_of_products(tin, tiling, *, levels, cells, seed):
    """Require every product of tiles to be that of the whole; return how many the whole has."""
    points, made = tin.points, 0
    grid = make_grid(points, cells)
    for value in ("elevation", "slope", "aspect", "hillshade"):
        for smooth in (None,) if value == "elevation" else (False, True):
            options = rasters.RasterOptions(grid, value, bool(smooth))
            whole = _make(ts.rasterize, tin, grid=grid, value=value, smooth=smooth)
            if whole is not None:
                found = join_raster(tiling, options, seed)
                require_same_bits(found, whole.bands[value], value)
                made += 1
    given = {"levels": levels}
    whole = _make(ts.contours, tin, **given)
    if whole is not None:
        require_same_features(join_contours(tiling, points, given, seed), whole)
        made += 1
    whole = _make(ts.contour_bands, tin, **given)
    found = None if whole is None else _make(join_bands, tiling, points, given, seed)
    if found is not None:  # polygons that meet themselves need the whole, thin triangles a tile
        require_same_features(found, whole)
        made += 1
    whole = _make(ts.volume, tin, base=levels[0])
    if whole is not None:
        options = make_volume_options(tin, levels[0], None)
        require_same_table(join_volumes(tiling, options, seed), whole)
        made += 1
    middle = 0.5 * points[:-1, :2] + 0.5 * points[1:, :2]
    asked = np.concatenate([points[:, :2], middle])
    require_same_bits(join_places(tiling, asked, seed), tin.interpolate(asked), "places")
    line = points[np.array([0, len(points) // 2, len(points) - 1]), :2]
    whole = _make(ts.profile, tin, line)
    if whole is not None:
        require_same_table(ts.profile(join_lines(tiling, tin, [line], seed), line), whole)
        made += 1
    return made


def _make(function, *given, **options):
    """Return a product, or None if it is refused."""
    try:
        return function(*given, **options)
    except ts.TinsmithError:
        return None
