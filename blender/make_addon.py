"""Pack the add-on as a zip for Blender: the same files give the same bytes, uncompressed.

``python blender/make_addon.py`` writes ``build/tinsmith-blender-VERSION.zip``, or the file that is
named.
"""

import re
import sys
import zipfile
from pathlib import Path

HERE = Path(__file__).parent
PACKAGE = HERE / "tinsmith"
SUFFIXES = (".py", ".toml")
DATE = (1980, 1, 1, 0, 0, 0)
MODE = 0o100644 << 16


def read_version():
    """Return the version that the manifest tells."""
    manifest = (PACKAGE / "blender_manifest.toml").read_text("utf-8")
    return re.search(r'^version = "(.+)"$', manifest, re.MULTILINE)[1]


def list_files():
    """Return the files by their names in the zip, in the order of these."""
    found = {f"tinsmith/{path.name}": path for path in PACKAGE.iterdir() if path.suffix in SUFFIXES}
    found["tinsmith/LICENSE"] = HERE.parent / "LICENSE"
    return dict(sorted(found.items()))


def pack(target):
    """Write the zip."""
    target.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(target, "w") as packed:
        for name, path in list_files().items():
            entry = zipfile.ZipInfo(name, DATE)
            entry.external_attr = MODE
            entry.create_system = 3
            packed.writestr(entry, path.read_bytes())
    return target


if __name__ == "__main__":
    default = HERE.parent / "build" / f"tinsmith-blender-{read_version()}.zip"
    print(pack(Path(sys.argv[1]) if len(sys.argv) > 1 else default))
