"""The benchmark of the relief runs, and its peers agree."""

from benchmarks.answers import relief


def test_peers_agree_on_a_small_surface():
    outcome = relief.run(300, repeats=1)
    tasks = {(one.task, one.tool) for one in outcome.results}
    assert ("slope classes, dissolved", "shapely") in tasks
    assert (relief.SLOPES, "tinsmith") in tasks
    assert all(one.seconds > 0 for one in outcome.results)
