"""docs/formats.md is what its script writes, so that it tells what the registry knows."""

from __future__ import annotations

import importlib.util
from pathlib import Path

DOCS = Path(__file__).parents[3] / "docs"


def test_the_page_is_what_the_script_writes():
    spec = importlib.util.spec_from_file_location("make_formats", DOCS / "make_formats.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    assert script.PAGE.read_text(encoding="utf-8") == script.write_page(), (
        "run python docs/make_formats.py"
    )
