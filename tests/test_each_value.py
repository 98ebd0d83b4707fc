"""Of a product of parameters few cases hold each value."""

from __future__ import annotations

from itertools import product

import pytest
from support.each_value import choose_cases, mark_other_cases


@pytest.mark.each_value
@pytest.mark.parametrize("one", [1, 5, 7, 12, pytest.param(8, marks=pytest.mark.proof)])
@pytest.mark.parametrize("other", [2, 3, 19])
def test_there_are_as_few_cases_as_the_longest_list_has_values(one, other):
    sizes = (one, other, 3)
    cases = list(product(*map(range, sizes)))
    chosen = [cases[k] for k in choose_cases(cases)]
    assert len(chosen) == max(sizes)
    for place, size in enumerate(sizes):
        counts = [sum(case[place] == value for case in chosen) for value in range(size)]
        assert min(counts) >= 1
        assert max(counts) - min(counts) <= 1


def test_values_that_are_not_in_all_combinations_are_held():
    cases = [("a", 1), ("a", 2), ("b", 2), ("c", 3), ("c", 4), ("c", 1)]
    chosen = [cases[k] for k in choose_cases(cases)]
    assert {case[0] for case in chosen} == set("abc")
    assert {case[1] for case in chosen} == {1, 2, 3, 4}


def test_cases_that_are_left_out_are_proofs(request):
    """Of the fifteen cases of the first test four are run, and none that is a proof."""
    name = test_there_are_as_few_cases_as_the_longest_list_has_values.__name__
    module = request.node.parent
    every = [one for one in module.collect() if getattr(one, "originalname", "") == name]
    mark_other_cases(every)
    proofs = {one.nodeid for one in every if one.get_closest_marker("proof")}
    assert (len(every), len(proofs)) == (15, 11)
    assert proofs.isdisjoint(one.nodeid for one in request.session.items)
