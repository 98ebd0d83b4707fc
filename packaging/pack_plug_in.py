"""Pack a plug-in of another program as a zip: the same files give the same bytes, uncompressed.

``python packaging/pack_plug_in.py qgis`` writes ``build/tinsmith-qgis-VERSION.zip``, or the file
that is named after it; ``blender`` the same of the add-on.
"""

import re
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
METADATA = {"qgis": "metadata.txt", "blender": "blender_manifest.toml"}
"""Plug-ins by their folders, and the file that tells the version of each."""
SUFFIXES = (".py", ".svg", ".toml", ".txt")
DATE = (1980, 1, 1, 0, 0, 0)
MODE = 0o100644 << 16


def read_version(name):
    """Return the version that the metadata of a plug-in tell."""
    text = (ROOT / name / "tinsmith" / METADATA[name]).read_text("utf-8")
    return re.search(r'^version *= *"?([^"\n]+)', text, re.MULTILINE)[1]


def list_files(name):
    """Return the files by their names in the zip, in the order of these."""
    package = ROOT / name / "tinsmith"
    found = {
        f"tinsmith/{path.relative_to(package).as_posix()}": path
        for path in package.rglob("*")
        if path.suffix in SUFFIXES
    }
    found["tinsmith/LICENSE"] = ROOT / "LICENSE"
    return dict(sorted(found.items()))


def pack(name, target):
    """Write the zip."""
    target.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(target, "w") as packed:
        for inside, path in list_files(name).items():
            entry = zipfile.ZipInfo(inside, DATE)
            entry.external_attr = MODE
            entry.create_system = 3
            packed.writestr(entry, path.read_bytes())
    return target


if __name__ == "__main__":
    _, plug_in, *named = sys.argv
    default = ROOT / "build" / f"tinsmith-{plug_in}-{read_version(plug_in)}.zip"
    print(pack(plug_in, Path(named[0]) if named else default))
