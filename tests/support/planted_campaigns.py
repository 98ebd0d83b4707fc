"""Campaigns with defects put in on purpose: what tests the runner of the campaigns."""

import os
import time

import numpy as np
from fuzz.campaign import Campaign, Case


def generate(rng: np.random.Generator) -> Case:
    return {"numbers": rng.integers(0, 1000, 12).tolist(), "word": "abcdef"}


def fail(case: Case) -> str:
    assert not any(number > 900 for number in case["numbers"]), "a number above 900"
    return "small" if max(case["numbers"], default=0) < 500 else "large"


def hang(case: Case) -> None:
    if any(number > 950 for number in case["numbers"]):
        time.sleep(600)


def abort(case: Case) -> None:
    if any(number > 950 for number in case["numbers"]):
        os.abort()


def swell(case: Case) -> None:
    if any(number > 950 for number in case["numbers"]):
        bytearray(10 << 30)


def depend(case: Case) -> None:
    """Fail by what ran before: no case of its own is at fault."""
    seen.append(1)
    assert len(seen) < 5


seen: list[int] = []

CAMPAIGNS = (
    Campaign("fails", "fails now and then", generate, fail),
    Campaign("hangs", "hangs now and then", generate, hang, seconds=1.0),
    Campaign("aborts", "dies now and then", generate, abort),
    Campaign("swells", "takes all memory now and then", generate, swell, megabytes=512),
    Campaign("depends", "fails by its history", generate, depend),
)
