"""What all tests share: long proofs run only when asked for; pictures need OpenGL."""

from __future__ import annotations

import pytest
from hypothesis import settings
from no_skips import (  # noqa: F401 - hooks
    pytest_addoption,
    pytest_make_collect_report,
    pytest_runtest_makereport,
)

from tinsmith.terrain import opengl
from tinsmith.tin import TinsmithError

# Every test has a time limit; the milliseconds of one example depend on who else is at work.
settings.register_profile("tinsmith", deadline=None)
settings.load_profile("tinsmith")


@pytest.fixture(scope="session")
def can_draw():
    """Skip the test where no picture can be drawn."""
    try:
        opengl.require_opengl()
    except TinsmithError as error:
        pytest.skip(str(error))


def pytest_collection_modifyitems(config, items):
    if "proof" in config.option.markexpr:
        return
    proofs = [item for item in items if item.get_closest_marker("proof")]
    config.hook.pytest_deselected(items=proofs)
    items[:] = [item for item in items if not item.get_closest_marker("proof")]
