"""Write docs/formats.md: what every format keeps, as the registry says.

python docs/make_formats.py
"""

from __future__ import annotations

from pathlib import Path

import tinsmith as ts

PAGE = Path(__file__).with_name("formats.md")

_HEAD = """\
# Formats: what each keeps

*Written by `docs/make_formats.py` from the registry; `tinsmith formats` shows the same for what is
installed, `tinsmith formats --json` for a program.*

A **TIN** is a surface, a **Survey** points with what is known of them, **Features** are points,
lines or polygons, a **Raster** cells, a **Table** named columns. A reader is chosen by the content
of a file, else by its suffix; a writer by what there is to write and the suffix. `format=`
(`--format`, `--output-format`) names one whatever the suffix.

"""

_WHOLE = """
## Which format for a TIN

**`.gpkg` keeps everything**: points, triangles, constrained edges, lines with their names and
kinds, water, CRS, units, the report, and what edits and undoing them need. Read back, the TIN
equals the one that was written bit for bit, and so do its edits. QGIS, ArcGIS and GDAL open its
layers (`vertices`, `triangles` with slope and aspect, `lines`, `boundary`, `water`) at once.
Compared, for a TIN of 1 million triangles, on one core of a busy machine:

| format | size | write | read | who reads it | what is lost |
|---|---|---|---|---|---|
| GeoPackage, by SQLite alone | 219 MB | 5.4 s | 3.4 to 4.7 s | every GIS | nothing |
| GeoPackage of the triangles, by GDAL | 284 MB | 8.0 s | | every GIS | what is no layer |
| PLY with edges | 25 MB | 0.1 s | 0.7 s | QGIS (mesh), CloudCompare, MeshLab | report, undoing |
| Parquet, two tables | 24 MB | 0.3 s | 0.03 s | tools of columns | what tables cannot say |

GDAL's file has a spatial index, which SQLite alone would fill one triangle after the other, in
21 s. Parquet and Arrow hold tables: a TIN in them is several files, or a layout that no other
program knows, so they were not chosen. Take PLY to look at a surface as a mesh, and where size
counts.

## Formats and commands of other packages

Another package adds formats through the entry-point group `tinsmith.formats`, each entry naming a
`tinsmith.Format`, and commands through `tinsmith.commands`, each naming a `click.Command`.
[`docs/examples/tinsmith-ifc`](examples/tinsmith-ifc/README.md) is one to copy: it writes IFC 4.

```toml
[project.entry-points."tinsmith.formats"]
ifc = "tinsmith_ifc:IFC"
```

- A plug-in that cannot be loaded, or is at fault, is left out with a warning that names its
  distribution and version.
- Built-in formats and commands cannot be replaced. A suffix that a plug-in and another format claim
  for the same thing is refused where it is used, and the sentence names both: `format=` chooses.
- A reader takes `(path, *, crs=None, z_unit=None)` and options of its own, and returns a Survey or
  a TIN; a writer takes `(obj, path)` and options of its own.
"""


def write_page() -> str:
    """Return the text of the page."""
    formats = [one for one in ts.known_formats() if one.is_built_in]
    return _HEAD + _draw_table(formats) + _WHOLE


def _draw_table(formats: list[ts.Format]) -> str:
    rows = [
        "| format | suffixes | reads | writes | needs | precision | what is lost |",
        "|---" * 7 + "|",
    ]
    for one in formats:
        cells = [
            f"**{one.name}**: {one.description}",
            " ".join(f"`{suffix}`" for suffix in one.suffixes),
            ", ".join(one.reads) if one.read else "-",
            ", ".join(one.writes) if one.write else "-",
            f"`{one.needs}`" if one.needs else "-",
            one.precision if one.write else "-",
            (one.losses or "Nothing.") if one.write else one.losses or "-",
        ]
        rows.append(f"| {' | '.join(cell.replace('|', '/') for cell in cells)} |")
    return "\n".join(rows) + "\n"


if __name__ == "__main__":
    PAGE.write_text(write_page(), encoding="utf-8")
