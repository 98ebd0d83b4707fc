"""The benchmark of sight runs, and what it compares agrees."""

import numpy as np
import pytest

from benchmarks.answers import sight


def test_viewsheds_and_lines_agree_on_a_small_surface():
    outcome = sight.run(1600, repeats=1)
    tasks = {(one.task, one.tool) for one in outcome.results}
    assert (sight.VIEWSHED, "tinsmith") in tasks
    assert ("lines of sight: to 1,000 vertices", "tinsmith") in tasks
    assert all(one.seconds > 0 for one in outcome.results)


def test_a_peer_that_sees_other_vertices_is_an_error():
    seen = np.arange(100) < 50
    sight._require_alike(seen, seen)
    with pytest.raises(AssertionError, match=r"only 50\.0%"):
        sight._require_alike(seen, np.zeros(100, bool))
