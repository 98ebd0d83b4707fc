"""How many tables that are plain to a person are read: a part of the campaign of layouts."""

from __future__ import annotations

from collections import Counter

import pytest
from fuzz.campaign import make_case
from fuzz.layouts import CAMPAIGNS, examine

PLAIN_SHARE = 0.9


def count_outcomes(seed: int, cases: int) -> Counter[str]:
    return Counter(examine(make_case(CAMPAIGNS[0], seed, number)) for number in range(cases))


def share_of_plain(outcomes: Counter[str]) -> float:
    read, refused = outcomes["plain: read"], outcomes["plain: refused"]
    return read / (read + refused)


def test_plain_tables_are_read_and_no_table_is_read_wrong():
    outcomes = count_outcomes(seed=3, cases=150)
    assert share_of_plain(outcomes) >= PLAIN_SHARE, outcomes
    assert outcomes["contradictory: refused"] > outcomes["contradictory: read"]


@pytest.mark.proof
@pytest.mark.timeout(3600)
def test_plain_tables_of_many_are_read_and_none_is_read_wrong():
    outcomes = count_outcomes(seed=4, cases=20_000)
    assert share_of_plain(outcomes) >= PLAIN_SHARE, outcomes
