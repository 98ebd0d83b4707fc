"""Print pages and tables again from what was measured: ``python -m benchmarks.report FILE.json``.

A file is one that ``python -m benchmarks`` wrote, or one of the option ``--json`` of another
benchmark.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from .page import format_page
from .tables import Table


def format_file(path: Path) -> str:
    """Return the Markdown of a file of results."""
    content = json.loads(path.read_text(encoding="utf-8"))
    return format_page(content, path.stem) if "results" in content else str(Table.read(path))


if __name__ == "__main__":
    for place in sys.argv[1:]:
        print(format_file(Path(place)), end="")
