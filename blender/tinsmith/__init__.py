"""Import of TINs (PLY) and lines (GeoPackage) that tinsmith wrote, into Blender."""

bl_info = {
    "name": "Tinsmith TIN Import",
    "author": "tinsmith contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "File > Import > TIN of tinsmith",
    "description": "Imports TINs and lines of tinsmith at true scale, near the origin",
    "category": "Import-Export",
}
"""What Blender before 4.2 asks; newer ones read the manifest."""


def register() -> None:
    """Add the import to Blender."""
    from . import operators

    operators.register()


def unregister() -> None:
    """Take the import out of Blender."""
    from . import operators

    operators.unregister()
