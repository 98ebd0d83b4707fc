"""Write docs/formats.md: what every format keeps, as the registry says.

python docs/make_formats.py
"""

from __future__ import annotations

import re
from pathlib import Path

import tinsmith as ts

PAGE = Path(__file__).with_name("formats.md")

_HEAD = """\
# Formats: what each keeps

*Written by `docs/make_formats.py` from the registry; `tinsmith formats` shows the same for what is
installed, `tinsmith formats --json` for a program.*

A **TIN** is a surface, a **Survey** points with lines and attributes, **Features** are points,
lines or polygons, a **Raster** cells, a **Table** named columns. A reader is chosen by the content
of a file, else by its suffix; a writer by the type of the object and the suffix. `format=`
(`--format`, `--output-format`) overrides both. [Which format for a TIN](#which-format-for-a-tin)
compares the main ones.

"""

_OPTIONS = """
## Options of formats

`ts.read` and `ts.io.write` take them by name, every command as a flag (`z_field` is `--z-field`);
`tinsmith COMMAND FILE --help` lists those of a file, `tinsmith formats NAME` those of a format. An
option of writing is `--output-NAME` where the command or the format of its input has one of that
name. Every reader also takes `crs` and `elevation_unit`.

"""

_WHOLE = """
## Which format for a TIN

**`.gpkg` keeps everything**: points, triangles, constrained edges, lines with their names and
kinds, water, CRS, units, the report, and the history of edits for undo. The TIN read back equals
the one written bit for bit, edits included. QGIS, ArcGIS and GDAL open its layers (`vertices`,
`triangles` with slope and aspect, `lines`, `boundary`, `water`). For a TIN of 1 million triangles,
on one core of a shared machine:

| format | size | write | read | read by | what is lost |
|---|---|---|---|---|---|
| GeoPackage, by SQLite alone | 219 MB | 5.4 s | 3.4 to 4.7 s | every GIS | nothing |
| GeoPackage of the triangles, by GDAL | 284 MB | 8.0 s | | every GIS | all but the triangles |
| PLY with edges | 25 MB | 0.1 s | 0.7 s | CloudCompare, MeshLab, Blender | report, undo |
| Parquet, two tables | 24 MB | 0.3 s | 0.03 s | columnar tools | what tables cannot hold |

GDAL's file has a spatial index; filling one by SQLite alone would take 21 s. Parquet and Arrow
hold tables: a TIN needs several files, or a layout that no other program reads, so they are not
used for whole TINs. Use PLY to view a surface in CloudCompare, MeshLab or Blender, and where size
matters; of a PLY with breaklines QGIS draws these alone, so for a mesh layer use UGRID (`.nc`).

## Formats and commands of other packages

Another package adds formats through the entry-point group `tinsmith.formats`, each entry naming a
`tinsmith.Format`, and commands through `tinsmith.commands`, each naming a `click.Command`.
[`docs/examples/tinsmith-x3d`](examples/tinsmith-x3d/README.md) is one to copy: it writes X3D.

```toml
[project.entry-points."tinsmith.formats"]
x3d = "tinsmith_x3d:X3D"
```

- A plug-in that cannot be loaded or is invalid is skipped, with a warning that names its
  distribution and version.
- Built-in formats and commands cannot be replaced. If a plug-in and another format claim the same
  suffix for the same type, using it is an error that names both; `format=` decides.
- A reader takes `(path, *, crs=None, elevation_unit=None)` and options of its own, and returns a
  Survey or a TIN; a writer takes `(obj, path)` and options of its own.
"""


def write_page() -> str:
    """Return the text of the page."""
    formats = [one for one in ts.known_formats() if one.is_built_in]
    return _HEAD + _draw_table(formats) + _OPTIONS + _draw_options(formats) + _WHOLE


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


def _draw_options(formats: list[ts.Format]) -> str:
    """Return a row for each option, with all formats where the same is said of it."""
    rows: dict[tuple[str, str, str], list[str]] = {}
    for way in ("read", "write"):
        for one in formats:
            for option in one.describe_options(way):
                text = re.sub(r":\w+:`\.?(.*?)`", r"`\1`", option.text).replace("``", "`")
                rows.setdefault((way, option.name, text), []).append(one.name)
    lines = ["| | option | of | |", "|---|---|---|---|"]
    for (way, name, text), names in rows.items():
        lines.append(f"| {way} | `{name}` | {', '.join(names)} | {text.replace('|', '/')} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(write_page(), encoding="utf-8")
