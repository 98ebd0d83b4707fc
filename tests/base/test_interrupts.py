"""Ctrl-C reaches the long kernels of products."""

from __future__ import annotations

import signal
from contextlib import contextmanager
from time import process_time

import numpy as np
import pytest

import tinsmith as ts
from tinsmith.terrain import _kernel

pytestmark = pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs timers of POSIX")

SOON = 0.1
"""Seconds until the signal, long before any of these is done.

All seconds here are of processor time, as a busy machine lets any time pass by the clock.
"""


class Pressed(Exception):
    """Ctrl-C, as a test can raise it."""


def press(*_):
    raise Pressed


@contextmanager
def pressed_after(seconds):
    """Have Ctrl-C pressed within the block, which must end by that."""
    with pytest.raises(Pressed), pressing(seconds):
        yield


@contextmanager
def pressing(seconds):
    before = signal.signal(signal.SIGPROF, press)
    try:
        signal.setitimer(signal.ITIMER_PROF, seconds)
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def tall(count):
    """Return many triangles, each of which reaches over all levels."""
    rng = np.random.default_rng(0)
    xy = rng.random((count, 3, 2)) * 100
    (ax, ay), (bx, by) = ((xy[:, k] - xy[:, 0]).T for k in (1, 2))
    turned = ax * by - ay * bx < 0
    xy[turned] = xy[turned][:, ::-1]
    points = np.concatenate([xy, np.tile([[0.0], [50], [100]], (count, 1, 1))], axis=2)
    return points.reshape(-1, 3), np.arange(3 * count, dtype=np.int32).reshape(-1, 3)


def prepare_stage_sums():
    return _kernel.stage_sums, (*tall(5000), np.linspace(1, 99, 100_000), 1.0)


def prepare_sum_between():
    lower = (*tall(20_000), np.zeros(20_000, np.int32), 1)
    return _kernel.sum_between, (*lower, *tall(20_000), 1.0, False, 1)


@pytest.mark.parametrize("prepare", [prepare_stage_sums, prepare_sum_between])
def test_a_kernel_ends_soon_after_the_signal(prepare):
    kernel, given = prepare()
    began = process_time()
    with pressed_after(SOON):
        kernel(*given)
    assert process_time() - began < 10.0


def prepare_strips():
    """One triangle in many strips."""
    surface = _kernel.FallingSurface(
        np.array([[0.0, 0, 0], [1, 0, 1], [0, 1, 1]]),
        np.array([[0, 1, 2]], np.int32),
        np.full((1, 3), -1, np.int32),
        np.array([[-1, 1, 1]], np.int8),
        np.array([[-2.0, 1, 1]]),
        None,
    )
    count = 8_000_000
    starts = np.linspace(0.0, 1.0, count, endpoint=False)
    return surface.link_strips, (np.array([0, count]), starts, np.zeros(3, np.int32))


def prepare_long_way():
    return _kernel.find_ends, (np.minimum(np.arange(1, 30_000_001, dtype=np.int32), 29_999_999),)


@pytest.mark.parametrize("prepare", [prepare_strips, prepare_long_way])
def test_the_network_of_water_ends_soon_after_the_signal(prepare):
    kernel, given = prepare()
    began = process_time()
    kernel(*given)
    whole = process_time() - began
    began = process_time()
    with pressed_after(0.2 * whole):
        kernel(*given)
    assert process_time() - began < 0.8 * whole


def test_sums_of_heights_end_soon_after_the_signal():
    """One triangle eight million times: what takes long must not wait for its end."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    triangles = np.tile(np.arange(3, dtype=np.int32), (8_000_000, 1))
    given = points, triangles, np.ones(3), np.zeros(len(triangles), np.int32), 1, 1.0
    began = process_time()
    _kernel.sum_heights(*given)
    whole = process_time() - began
    began = process_time()
    with pressed_after(0.2 * whole):
        _kernel.sum_heights(*given)
    assert process_time() - began < 0.8 * whole


@pytest.mark.slow
def test_lines_of_many_levels_end_soon_after_the_signal():
    x, y = np.meshgrid(np.arange(60.0), np.arange(60.0))
    z = np.random.default_rng(1).random(x.size)
    tin = ts.triangulate(np.column_stack([x.ravel(), y.ravel(), z]))
    with pressed_after(SOON):
        ts.contours(tin, levels=np.linspace(0.001, 0.999, 100_000))
