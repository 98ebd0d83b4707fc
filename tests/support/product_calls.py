"""A call of every public function of a surface, on a hill whose reader had something to say."""

from pathlib import Path
from tempfile import mkdtemp

import numpy as np

import tinsmith as ts

NOTE = "Row 7 of the book was illegible."


def make_hill(z=0.0):
    """Return a hill of 400 points with one elevation of 0, whose reader had something to say."""
    x, y = np.divmod(np.arange(400.0), 20)
    points = np.column_stack([700_000 + 5 * x, 4_000_000 + 5 * y, 320 + np.sin(x / 3) + 0.1 * y])
    points[213, 2] = z
    survey = ts.Survey(points=points, crs="EPSG:32616", elevation_unit="m", notes=[NOTE])
    return ts.triangulate(survey)


HILL = make_hill()
AXIS = np.array([[700_020.0, 4_000_020, 322], [700_030, 4_000_020, 322]])
ROAD = ts.Template(ts.Side([ts.Part("lane", 3.0, -0.02)], cut_slope=1, fill_slope=1))
PLACE = [700_040.0, 4_000_041.0]
LINE = [[700_003.0, 4_000_003.0], [700_090.0, 4_000_080.0]]
RING = [[700_030, 4_000_030], [700_060, 4_000_030], [700_060, 4_000_060], [700_030, 4_000_060]]

CORNER = [[700_012, 4_000_012], [700_020, 4_000_012], [700_020, 4_000_020]]
"""A pad away from the vertex of elevation 0."""

RIVER = [[700_010, 4_000_050], [700_080, 4_000_050], [700_080, 4_000_058], [700_010, 4_000_058]]
RIVER_AXIS = [[700_010.0, 4_000_054.0], [700_080.0, 4_000_054.0]]

RESULTS = {
    "aspect_classes": ts.aspect_classes,
    "catchments": ts.catchments,
    "contour_bands": lambda tin: ts.contour_bands(tin, 5.0),
    "contours": lambda tin: ts.contours(tin, 1.0, smooth=0.1),
    "cross_sections": lambda tin: ts.cross_sections(tin, LINE, interval=20.0, width=20.0),
    "depressions": ts.depressions,
    "difference": lambda tin: ts.difference(tin, ts.triangulate(HILL.points, crs=HILL.crs)),
    "drape": lambda tin: ts.drape(
        tin, ts.Features.of_lines(LINE, [0, 2], crs=HILL.crs), outside="nan"
    ),
    "flats": ts.flats,
    "flow_accumulation": ts.flow_accumulation,
    "flow_path": lambda tin: ts.flow_path(tin, [PLACE]),
    "hillshade": lambda tin: ts.hillshade(tin, spacing=5.0),
    "line_of_sight": lambda tin: ts.line_of_sight(tin, [PLACE], [LINE[1]], eye_height=2.0),
    "pits": ts.pits,
    "plan": ts.plan,
    "ponds": lambda tin: ts.ponds(tin, 300.0),
    "preview": ts.preview,
    "profile": lambda tin: ts.profile({"ground": tin}, LINE),
    "rasterize": lambda tin: ts.rasterize(tin, spacing=5.0),
    "rasterize_canopy": lambda tin: ts.rasterize_canopy(tin, HILL.points, spacing=5.0),
    "rasterize_heights": lambda tin: ts.rasterize_heights(tin, HILL.points, spacing=5.0),
    "ridges_and_valleys": ts.ridges_and_valleys,
    "section_lines": lambda tin: ts.section_lines(tin, LINE, interval=20.0, width=20.0),
    "profile_sheets": lambda tin: ts.profile_sheets(tin, LINE),
    "section_sheets": lambda tin: ts.section_sheets(tin, LINE, interval=20.0, width=20.0),
    "section_volumes": lambda tin: ts.section_volumes(
        tin, ts.triangulate(HILL.points, crs=HILL.crs), LINE, interval=20.0, width=20.0
    ),
    "slope_classes": ts.slope_classes,
    "slope_statistics": ts.slope_statistics,
    "stakeout": lambda tin: ts.stakeout(tin, [PLACE]),
    "stage_storage": lambda tin: ts.stage_storage(tin, interval=50.0),
    "to_features": ts.to_features,
    "viewshed": lambda tin: ts.viewshed(tin, PLACE, eye_height=2.0),
    "volume_report": lambda tin: ts.volume_report(tin, base=318.0),
    "volume": lambda tin: ts.volume(tin, base=318.0),
    "balance": lambda tin: ts.balance(tin, CORNER, cut_slope=2.0, fill_slope=2.0),
    "coregister": lambda tin: ts.coregister(tin, ts.triangulate(HILL.points, crs=HILL.crs)),
    # surfaces
    "merge": lambda tin: ts.merge([ts.triangulate(add_height(RING, 330), crs=HILL.crs), tin]),
    "corridor": lambda tin: ts.corridor(tin, AXIS, ROAD),
    "hydroflatten": lambda tin: ts.hydroflatten(
        tin, RIVER, RIVER_AXIS, spacing=10.0, downstream="along"
    ),
    "clip": lambda tin: ts.clip(tin, [RING]),
    "mend_flats": ts.mend_flats,
    "paste": lambda tin: ts.paste(tin, ts.triangulate(add_height(RING, 330), crs=HILL.crs)),
    "refine": lambda tin: ts.refine(tin, min_angle=20.0),
    "reproject": lambda tin: ts.reproject(tin, "EPSG:32617"),
    "simplify": lambda tin: ts.simplify(tin, tolerance=0.1),
}
"""Products with notes."""

PICTURES = {
    "blunder_map": lambda tin: ts.blunder_map(tin, ts.blunders(HILL)),
    "contour_map": ts.contour_map,
    "earthwork_map": lambda tin: ts.earthwork_map(ts.difference(HILL, HILL), ground=tin),
    "relief_map": ts.relief_map,
}

OTHERS = {
    "aspect": ts.aspect,
    "blunders": ts.blunders,  # is itself what notes tell
    "check": ts.check,
    "check_contours": lambda tin: ts.check_contours(tin, ts.contours(HILL, 1.0)),
    "combined_factor": ts.combined_factor,
    "curvature": ts.curvature,
    "grade": lambda tin: ts.grade(tin, RING, 325.0, cut_slope=2.0, fill_slope=2.0),
    "height_above": lambda tin: ts.height_above(tin, HILL.points),
    "lift": ts.lift,
    "quality": ts.quality,
    "slope": ts.slope,
    "to_matplotlib": ts.to_matplotlib,
    "to_meshio": ts.to_meshio,
    "to_pyvista": ts.to_pyvista,
    "to_trimesh": ts.to_trimesh,
    "to_ugrid": ts.to_ugrid,
    "visible_vertices": lambda tin: ts.visible_vertices(tin, PLACE, eye_height=2.0),
    "voronoi": ts.voronoi,
    "write": lambda tin: ts.write(tin, Path(mkdtemp(), "hill.ply")),
}
"""Products that are arrays, or belong to other libraries."""

ALL = {**RESULTS, **PICTURES, **OTHERS}


def add_height(ring, z):
    return np.column_stack([ring, np.full(len(ring), float(z))])
