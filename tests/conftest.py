"""What all tests share: long proofs and slow tests run when asked for; pictures need OpenGL."""

from __future__ import annotations

import gc

import hypothesis
import pytest
from support import durations, each_value, no_skips
from support.no_skips import (  # noqa: F401 - hooks
    pytest_make_collect_report,
    pytest_runtest_makereport,
)

from tinsmith.terrain.viewer import opengl
from tinsmith.tin import TinsmithError

# A timing is never a test; a test that hangs ends at pytest's own limit. The same commit is tested
# with the same examples, few where campaigns draw thousands; --hypothesis-profile=explore draws
# others each time, and more.
hypothesis.settings.register_profile("explore", deadline=None)
hypothesis.settings.register_profile(
    "tinsmith", deadline=None, derandomize=True, database=None, max_examples=30
)
hypothesis.settings.load_profile("tinsmith")

# Collecting makes millions of objects that stay: the collector would look through them in vain.
gc.disable()


def pytest_addoption(parser):
    no_skips.pytest_addoption(parser)
    parser.addoption("--record-durations", action="store_true", help="write durations.json anew")


def pytest_configure(config):
    if config.getoption("--record-durations") and not hasattr(config, "workerinput"):
        config.pluginmanager.register(durations.Recorder(), "durations")


@pytest.fixture(scope="session")
def can_draw():
    """Skip the test where no picture can be drawn."""
    try:
        opengl.require_opengl()
    except TinsmithError as error:
        pytest.skip(str(error))


def pytest_collection_modifyitems(config, items):
    each_value.mark_other_cases(items)
    durations.mark_long_tests(items, durations.read_durations())
    left = {item for item in items if durations.is_left_out(item, config.option.markexpr)}
    config.hook.pytest_deselected(items=[item for item in items if item in left])
    items[:] = [item for item in items if item not in left]


def pytest_collection_finish():
    """Keep the collector from searching thousands of tests through again and again."""
    gc.freeze()
    gc.enable()
