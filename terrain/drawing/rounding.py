"""Round numbers for people: lengths, ticks and exaggerations that are easy to read."""

from __future__ import annotations

import math


def round_down(value: float) -> float:
    """Return the largest of 1, 2, 5 times a power of ten that is at most ``value`` (above 0).

    Examples
    --------
    >>> round_down(0.7), round_down(430), round_down(20)
    (0.5, 200.0, 20.0)
    """
    power = 10.0 ** math.floor(math.log10(value))
    fitting = (lead * power for lead in (5.0, 2.0, 1.0) if lead * power <= value * (1 + 1e-9))
    return next(fitting, power / 2)


def choose_ticks(low: float, high: float, *, count: int) -> list[float]:
    """Return round values within [low, high], about ``count`` of them.

    Examples
    --------
    >>> choose_ticks(212.4, 268.1, count=5)
    [220.0, 230.0, 240.0, 250.0, 260.0]
    """
    if not high > low:
        return []
    step = round_down((high - low) / count * 1.3)
    first, last = math.ceil(low / step), math.floor(high / step)
    return [round(k * step, 12) for k in range(first, last + 1)]


def format_number(value: float, *, step: float) -> str:
    """Write a number with the decimals that a step needs, thousands parted by a comma.

    Examples
    --------
    >>> format_number(12500, step=500), format_number(0.5, step=0.25)
    ('12,500', '0.50')
    """
    decimals = 0
    while decimals < 9 and not math.isclose(round(step, decimals), step, rel_tol=1e-6):
        decimals += 1
    return f"{value:,.{decimals}f}"
