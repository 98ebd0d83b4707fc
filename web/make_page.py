"""Compile the triangulation to WebAssembly, and pack it into one page that works offline.

``python web/make_page.py`` writes ``build/tinsmith-web.html``, or the file that is named. It needs
Emscripten (``em++``). Multiplications and additions are rounded one by one: WebAssembly has no
fused ones, and the compiler is told to make none.
"""

import base64
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
SOURCE = HERE / "triangulate.cpp"
FUNCTIONS = ("allocate_rows", "free_rows", "clean_rows", "triangulate", "corners", "kept_rows")
OPTIONS = (
    *("-std=c++17", "-O3", "-ffp-contract=off", "-fwasm-exceptions"),
    "-Wno-bitwise-conditional-parentheses",
    *("--no-entry", "-sSTANDALONE_WASM=1"),
    *("-sALLOW_MEMORY_GROWTH=1", "-sMAXIMUM_MEMORY=4GB"),
    "-sEXPORTED_FUNCTIONS=" + ",".join(f"_{name}" for name in FUNCTIONS),
)


def compile_core():
    """Return the triangulation as WebAssembly."""
    compiler = shutil.which("em++")
    if compiler is None:
        raise SystemExit(
            "em++ is missing: install Emscripten (Debian: apt-get install emscripten)."
        )
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder, "core.wasm")
        subprocess.run([compiler, *OPTIONS, "-o", str(made), str(SOURCE)], check=True)
        return made.read_bytes()


def pack(target):
    """Write the page."""
    parts = {
        "core": base64.b64encode(compile_core()).decode(),
        "worker": (HERE / "worker.js").read_text("utf-8"),
        "page": (HERE / "page.js").read_text("utf-8"),
    }
    page = (HERE / "page.html").read_text("utf-8")
    for name, text in parts.items():
        page = page.replace(f"@{name}@", text)
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(page, "utf-8")
    return target


if __name__ == "__main__":
    default = HERE.parent / "build" / "tinsmith-web.html"
    print(pack(Path(sys.argv[1]) if len(sys.argv) > 1 else default))
