"""The import, as an operator of Blender and an entry of its menu.

Annotations are no strings here: those of the operator are its properties.
"""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from . import geopackage, ply
from .reference import Placement, Reference, Refused, Unit, choose_placement
from .scene import add_content

_READERS = {".ply": ply.read, ".gpkg": geopackage.read}
_UNITS = (
    ("FILE", "As the file says", "Refuse a file that does not say it"),
    ("metre", "Metre", ""),
    ("foot", "Foot", "International foot, 0.3048 m"),
    ("US survey foot", "US survey foot", "1200 / 3937 m"),
)


class ImportTin(bpy.types.Operator, ImportHelper):
    """Import a TIN (.ply) or lines such as contours (.gpkg) that tinsmith wrote."""

    bl_idname = "import_scene.tinsmith"
    bl_label = "Import TIN"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - Blender reads it

    filename_ext = ".ply"
    filter_glob: StringProperty(default="*.ply;*.gpkg", options={"HIDDEN"})  # type: ignore[valid-type]
    unit: EnumProperty(  # type: ignore[valid-type]
        name="Unit of coordinates",
        description="Needed where the file does not say it",
        items=_UNITS,
    )
    elevation_unit: EnumProperty(  # type: ignore[valid-type]
        name="Unit of elevations",
        description="Where the file does not say it; else that of the coordinates",
        items=_UNITS,
    )
    scale: FloatProperty(  # type: ignore[valid-type]
        name="Scale",
        description="Of the first file of a scene: 1 is true size, 0.001 is 1:1000",
        default=1.0,
        min=1e-6,
        max=1e3,
    )
    line_width: FloatProperty(  # type: ignore[valid-type]
        name="Width of lines",
        description="Metres; 0 for lines that are not rendered",
        default=0.2,
        min=0.0,
    )
    take_crs: BoolProperty(  # type: ignore[valid-type]
        name="CRS of the scene",
        description="Take a file that names no CRS to be in that of the scene",
        default=False,
    )

    def execute(self, context: Any) -> set[str]:
        """Import the file; nothing is added to the scene if it is refused."""
        path = Path(self.filepath)
        try:
            told = self.add(context, path)
        except Refused as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        except OSError as error:
            self.report({"ERROR"}, f"'{path.name}' cannot be read: {error.strerror}.")
            return {"CANCELLED"}
        self.report({"INFO"}, " ".join(told))
        return {"FINISHED"}

    def add(self, context: Any, path: Path) -> list[str]:
        """Add the objects of a file; return what is to be told."""
        read = _READERS.get(path.suffix.lower())
        if read is None:
            raise Refused(f"'{path.name}': a TIN as .ply, or lines as .gpkg, can be imported.")
        content = read(path)
        scene = context.scene
        there = Placement.from_properties(scene)
        parts = [line.points for line in content.lines]
        parts += [] if content.points is None else [content.points]
        every = np.concatenate(parts)
        asked = Reference(
            there.crs if there and self.take_crs else "",
            Unit.find(self.unit),
            Unit.find(self.elevation_unit),
        )
        scale = self.scale / scene.unit_settings.scale_length
        box = np.array([every.min(axis=0), every.max(axis=0)])
        placement, told = choose_placement(content.reference, box, there, asked, scale)
        add_content(context, content, placement, path.name, self.line_width)
        if there is None:
            for key, value in placement.to_properties().items():
                scene[key] = value
        return [*_count(content), f"CRS {content.reference.crs[:80] or 'not known'}.", *told]


def _count(content: Any) -> list[str]:
    counts = []
    if content.points is not None:
        counts = [f"{len(content.points):,} vertices", f"{len(content.triangles):,} triangles"]
    if content.lines:
        counts.append(f"{len(content.lines):,} lines")
    return [", ".join(counts) + "."]


def _add_entry(menu: Any, _: Any) -> None:
    menu.layout.operator(ImportTin.bl_idname, text="TIN of tinsmith (.ply, .gpkg)")


def register() -> None:
    """Add the operator and the entry of the menu."""
    bpy.utils.register_class(ImportTin)
    bpy.types.TOPBAR_MT_file_import.append(_add_entry)


def unregister() -> None:
    """Take both out again."""
    bpy.types.TOPBAR_MT_file_import.remove(_add_entry)
    bpy.utils.unregister_class(ImportTin)
