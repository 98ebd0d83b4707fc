"""The same points as files of every format that is read, none of which names a CRS."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts
from tinsmith.io.registry.lookup import known_formats

__all__ = ["READ", "write_points"]

READ = {one.name: one for one in known_formats() if one.read and one.is_built_in}
"""The formats that are read, by their names."""


def write_points(name: str, points: Any, folder: Path) -> Path:
    """Write points, as triangles where the format has only such; return the file."""
    points = np.asarray(points, float)
    path = folder / f"a{(*READ[name].suffixes, '')[0]}"
    if name in _BY_HAND:
        return _BY_HAND[name](points, path)
    if "TIN" not in READ[name].writes:
        return Path(ts.write(ts.Survey(points=points), path, format=name))
    kind = {"kind": "points"} if "kind" in READ[name].options("write") else {}
    return Path(ts.write(ts.triangulate(points), path, format=name, **kind))


def _write_landxml(points: Any, path: Path) -> Path:
    """Write points with a unit, which the format asks for."""
    ts.write(ts.triangulate(points, elevation_unit="m"), path, format="landxml")
    return path


def _write_geojson(points: Any, path: Path) -> Path:
    rows = [
        {"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": row}}
        for row in points.tolist()
    ]
    whole = json.dumps({"type": "FeatureCollection", "features": rows})
    lines = "\n".join(map(json.dumps, rows))
    path.write_text(whole if path.suffix == ".geojson" else lines)
    return path


def _write_gml(points: Any, path: Path) -> Path:
    members = "".join(
        f'<gml:featureMember><a fid="a.{i}"><g><gml:Point><gml:coordinates>{x},{y},{z}'
        "</gml:coordinates></gml:Point></g></a></gml:featureMember>"
        for i, (x, y, z) in enumerate(points.tolist())
    )
    path = path.with_suffix(".gml")
    path.write_text(
        '<?xml version="1.0"?><gml:FeatureCollection xmlns:gml="http://www.opengis.net/gml">'
        f"{members}</gml:FeatureCollection>"
    )
    return path


def _write_grid(points: Any, path: Path) -> Path:
    """Write three by three cells from the lowest corner of the points."""
    cell = float(np.ptp(points[:, :2], axis=0).max()) / 3
    x, y = points[:, :2].min(axis=0).tolist()
    path = path.with_suffix(".asc")
    head = f"ncols 3\nnrows 3\nxllcorner {x!r}\nyllcorner {y!r}\ncellsize {cell!r}\n"
    path.write_text(f"{head}1 2 3\n4 5 6\n7 8 9\n")
    return path


def _write_gsi(points: Any, path: Path) -> Path:
    words = "".join(
        f"*11{k:04d}+{k:016d} "
        + " ".join(f"8{i + 1}..06{v:+017d}" for i, v in enumerate(np.rint(row * 1e4).astype(int)))
        + " \n"
        for k, row in enumerate(points, start=1)
    )
    path.write_text(words)
    return path


def _trim(*values: float) -> list[str]:
    """Return numbers that fit into fields of 16 characters."""
    return [f"{value:.7f}" for value in values]


def _write_sdr(points: Any, path: Path) -> Path:
    text = f"00NM{'SDR33 V04-04.02':<20}{'05-Nov-20 08:00':<16}211111\n"
    for k, (x, y, z) in enumerate(points.tolist(), start=1):
        text += "08TP" + "".join(f"{one:<16}" for one in (k, *_trim(y, x, z), "GS")) + "\n"
    path.write_text(text)
    return path


def _write_dc(points: Any, path: Path) -> Path:
    text = f"00NM{'SC V10-70':<16}{'1021':<4}{'05-Jan-26 12:20':<16}111111\n"
    for k, (x, y, z) in enumerate(points.tolist(), start=1):
        text += "69KI" + "".join(f"{one:<16}" for one in (k, *_trim(y, x, z), "GS")) + "11\n"
    path.write_text(text)
    return path


def _write_jobxml(points: Any, path: Path) -> Path:
    rows = "".join(
        f"<Point><Name>{k}</Name><Code>GS</Code><Grid><North>{y}</North><East>{x}</East>"
        f"<Elevation>{z}</Elevation></Grid></Point>\n"
        for k, (x, y, z) in enumerate(points.tolist(), start=1)
    )
    path.write_text(f"<?xml version='1.0'?><JOBFile><Reductions>\n{rows}</Reductions></JOBFile>\n")
    return path


def _write_esri_tin(points: Any, folder: Path) -> Path:
    """Write the files of a folder that the reader asks for: no triangle is masked."""
    triangles = ts.triangulate(points).triangles
    rows = {
        "tnxy.adf": points[:, :2].astype(">f8"),
        "tnz.adf": points[:, 2].astype(">f4"),
        "tnod.adf": (triangles + 1).astype(">i4"),
        "tedg.adf": np.zeros((len(triangles), 3), ">i4"),
        "tmsx.adf": np.array([0, 6], ">i4"),
        "tmsk.adf": np.array([0, 0, 0], ">i4"),
    }
    folder.mkdir()
    for name, numbers in rows.items():
        (folder / name).write_bytes(numbers.tobytes())
    return folder


_BY_HAND = {
    "landxml": _write_landxml,
    "geojson": _write_geojson,
    "geojsonseq": _write_geojson,
    "vector": _write_gml,
    "raster": _write_grid,
    "gsi": _write_gsi,
    "sdr": _write_sdr,
    "dc": _write_dc,
    "jobxml": _write_jobxml,
    "esri-tin": _write_esri_tin,
}
