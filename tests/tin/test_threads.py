"""Threads: how many, several callers at once, the interpreter left free, Ctrl-C honoured."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from support.each_value import list_seeds
from support.kernel_datasets import DATASETS, make_points, require_same_growth, with_heights

import tinsmith as ts
from tinsmith.base.interrupts import hold_interrupts
from tinsmith.base.sentences import shown
from tinsmith.tin import _kernel
from tinsmith.tin.validation import threads as threads_module
from tinsmith.tin.validation.threads import LEAST_POINTS_PER_THREAD, thread_count

FOUR_CORNERS = [[0, 0, 1], [9, 0, 2], [9, 9, 3], [0, 9, 4]]


def require_same_tin(found, wanted):
    for name in ("points", "triangles", "neighbors", "vertex_of"):
        np.testing.assert_array_equal(getattr(found, name), getattr(wanted, name))
    assert found.report.to_dict() == wanted.report.to_dict()


# ------------------------------------------------------------------ how many


@pytest.mark.parametrize("threads", [0, -1, 1.5, 2.0, True, "2", np.nan, [2], (), np.True_])
def test_a_wrong_number_of_threads_is_named_in_one_sentence(threads):
    with pytest.raises(ts.OptionError) as error:
        ts.triangulate(FOUR_CORNERS, threads=threads)
    assert str(error.value) == (
        f"Invalid threads {shown(threads)}: it must be a whole number >= 1, or None."
    )


@pytest.mark.parametrize("rows", [FOUR_CORNERS[:3], FOUR_CORNERS])
@pytest.mark.parametrize("threads", [None, 1, 2, 8])
def test_more_threads_than_points_do_no_harm(rows, threads):
    tin = ts.triangulate(rows, threads=threads)
    assert len(tin.triangles) == len(rows) - 2
    assert ts.check(tin, points=rows).ok


@pytest.mark.parametrize("rows", [[], FOUR_CORNERS[:2], [[0, 0, 0], [1, 1, 1], [2, 2, 2]] * 5])
@pytest.mark.parametrize("threads", [2, 8])
def test_threads_report_the_same_faults(rows, threads):
    rows = np.reshape(np.array(rows, float), (-1, 3))
    with pytest.raises(ts.PointsError) as alone:
        ts.triangulate(rows, threads=1)
    with pytest.raises(ts.PointsError) as shared:
        ts.triangulate(rows, threads=threads)
    assert str(shared.value) == str(alone.value)


@pytest.mark.parametrize("fault", [np.nan, np.inf, -np.inf, 1e76, 1e-62])
@pytest.mark.parametrize("at", [0, 4_999, 9_999])
def test_a_bad_row_is_found_by_whichever_thread_has_it(fault, at):
    points = with_heights(np.random.default_rng(1).random((10_000, 2)))
    points[at, 1] = fault
    with pytest.raises(ts.PointsError, match=f"row {at}") as error:
        ts.triangulate(points, threads=3)
    assert error.value.rows == (at,)


def test_minus_zero_is_zero_in_every_thread():
    points = with_heights(np.random.default_rng(2).integers(-3, 4, (3_000, 2)))
    wanted = ts.triangulate(points + 0.0, threads=1)
    negated = np.where(points == 0, -0.0, points)
    require_same_tin(ts.triangulate(negated, threads=4), wanted)


@pytest.mark.parametrize("name", DATASETS)
def test_default_is_one_thread_for_few_points_and_changes_nothing(name):
    points = make_points(name, 2_000)
    require_same_tin(ts.triangulate(points), ts.triangulate(points, threads=4))


@pytest.mark.parametrize("policy", ["mean", "first", "last", "lowest", "highest"])
def test_duplicates_are_merged_alike(policy):
    points = with_heights(np.random.default_rng(3).integers(0, 40, (4_000, 2)))
    wanted = ts.triangulate(points, duplicates=policy, threads=1)
    assert wanted.report.n_vertices < wanted.report.n_rows
    for threads in (2, 3, 8):
        require_same_tin(ts.triangulate(points, duplicates=policy, threads=threads), wanted)


def test_snapped_points_are_merged_alike():
    points = with_heights(np.random.default_rng(4).random((3_000, 2)) * 30)
    wanted = ts.triangulate(points, snap=0.2, threads=1)
    assert wanted.report.n_vertices < wanted.report.n_rows
    require_same_tin(ts.triangulate(points, snap=0.2, threads=5), wanted)


def test_points_are_left_as_they_were():
    points = with_heights(np.random.default_rng(5).random((5_000, 2)))
    before = points.copy()
    ts.triangulate(points, threads=3)
    np.testing.assert_array_equal(points, before)


def test_default_takes_every_core_where_it_pays(monkeypatch):
    monkeypatch.setattr(threads_module, "available_cores", lambda: 6)
    assert thread_count(None, 3) == 1
    assert thread_count(None, 2 * LEAST_POINTS_PER_THREAD - 1) == 1
    assert thread_count(None, 2 * LEAST_POINTS_PER_THREAD) == 2
    assert thread_count(None, 10**8) == 6
    assert thread_count(4, 10**8) == 4
    assert thread_count(9, 10**8) == 9


def test_available_cores_are_those_of_this_process():
    if hasattr(os, "sched_getaffinity"):
        assert threads_module.available_cores() == len(os.sched_getaffinity(0))
    assert threads_module.available_cores() >= 1


# ------------------------------------------------------------------ several callers


@pytest.mark.parametrize("threads", [2, 3, 16])
def test_threads_that_take_over_from_each_other_change_nothing(threads):
    """The south is quick, the north is slow: whoever has the south is through first."""
    rng = np.random.default_rng(3)
    raster = np.stack(np.meshgrid(np.arange(400.0), np.arange(400.0)), axis=-1).reshape(-1, 2)
    scattered = rng.random((160_000, 2)) * [400, 400] + [0, 400]
    points = with_heights(np.concatenate([scattered, raster]))
    alone = _kernel.grow(points, threads=1)
    for _ in range(3):
        require_same_growth(_kernel.grow(points, threads=threads), alone)


def test_callers_at_the_same_time_get_their_own_tins():
    clouds = [make_points(name, 10_000) for name in ("uniform", "raster", "clusters", "circle")] * 2
    wanted = [ts.triangulate(points, threads=1) for points in clouds]
    together = threading.Barrier(4)

    def triangulate(points):
        together.wait(60)
        return ts.triangulate(points, threads=2)

    with ThreadPoolExecutor(max_workers=4) as pool:
        for found, tin in zip(pool.map(triangulate, clouds), wanted, strict=True):
            require_same_tin(found, tin)


def test_callers_may_share_one_array():
    points = make_points("scan lines", 10_000)
    wanted = ts.triangulate(points, threads=1)
    with ThreadPoolExecutor(max_workers=3) as pool:
        for found in pool.map(lambda n: ts.triangulate(points, threads=n), (1, 2, 3)):
            require_same_tin(found, wanted)


@pytest.mark.parametrize("threads", [1, 2])
def test_other_python_threads_run_meanwhile(threads):
    """A thread counts while the kernel works.

    The interpreter would take turns by itself only after the switch interval, made endless here:
    so the count advances within the call only if the kernel lets go of the interpreter. Several
    calls, as a busy machine may not run the counter during one of them.
    """
    points = make_points("uniform", 50_000)
    count, is_over = 0, threading.Event()

    def go_on_counting():
        nonlocal count
        while not is_over.is_set():
            count += 1
            time.sleep(0)  # hands the interpreter back

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e6)
    counter = threading.Thread(target=go_on_counting)
    counter.start()
    try:
        advanced = any(advances(points, threads, lambda: count) for _ in range(100))
    finally:
        sys.setswitchinterval(interval)
        is_over.set()
        counter.join()
    assert advanced


def advances(points, threads, value):
    before = value()
    _kernel.grow(points, threads=threads)
    return value() > before


# ------------------------------------------------------------------ Ctrl-C

needs_posix_signals = pytest.mark.skipif(
    os.name != "posix", reason="signals cannot be timed, nor sent to one process alone"
)


class StopError(Exception):
    """What the tests' own signal handler raises."""


def grow_for_ever(points, threads):
    while True:
        _kernel.grow(points, threads=threads)


@contextlib.contextmanager
def signals(handler, *, first, every=0.0):
    """Signal this process after so many seconds, and again and again if `every` is not 0."""
    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, first, every)
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


@needs_posix_signals
@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("name", ["uniform", "clusters", "circle"])
def test_kernel_lets_signals_through_all_along(name, threads):
    """A kernel that asked only at its end would hear of one signal, however many came."""
    points = make_points(name, 200_000)
    heard = []
    with signals(lambda *_: heard.append(1), first=1e-4, every=1e-4):
        _kernel.grow(points, threads=threads)
    assert len(heard) > 5


@needs_posix_signals
@pytest.mark.parametrize("threads", [1, 2, 5])
@pytest.mark.parametrize("name", ["uniform", "clusters", "circle"])
def test_what_a_signal_handler_raises_ends_the_kernel(name, threads):
    points = make_points(name, 100_000)
    wanted = _kernel.grow(points)

    def stop(*_):
        raise StopError

    for milliseconds in (1, 4, 12):
        with pytest.raises(StopError), signals(stop, first=milliseconds / 1000):
            grow_for_ever(points, threads)
    require_same_growth(_kernel.grow(points, threads=threads), wanted)


MANY_TRIANGULATIONS = """
import numpy as np
import tinsmith as ts

points = np.random.default_rng(7).random(({n}, 3))
ts.triangulate(points[:100])  # loads the core, which is slow with sanitizers
print("begin", flush=True)
while True:
    ts.triangulate(points, threads={threads})
"""


# However pytest was started, the child honours Ctrl-C as Python does by default.
HONOUR_CTRL_C = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)
"""

LONGEST = 600  # seconds, for a loaded machine; then the child is killed


def require_interrupted(program, seconds_before):
    """Run it, press Ctrl-C some time after it began its work, and see it end by that."""
    child = subprocess.Popen(
        [sys.executable, "-c", HONOUR_CTRL_C + program],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        assert child.stdout.readline() == "begin\n"
        time.sleep(seconds_before)
        assert child.poll() is None
        child.send_signal(signal.SIGINT)
        _, errors = child.communicate(timeout=LONGEST)
    finally:
        child.kill()
        child.communicate()
    assert errors.rstrip().endswith("KeyboardInterrupt")
    assert child.returncode == -signal.SIGINT


@needs_posix_signals
@pytest.mark.parametrize("threads", [1, 2])
def test_ctrl_c_ends_triangulations_in_a_loop(threads):
    require_interrupted(MANY_TRIANGULATIONS.format(n=300_000, threads=threads), 0.5)


@needs_posix_signals
@pytest.mark.proof
@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("seconds_before", [0.1, 0.7, 1.5, 3.0])
def test_ctrl_c_ends_large_triangulations(threads, seconds_before):
    """At whatever step it comes: cleaning, index, hull, growth, stitching."""
    require_interrupted(MANY_TRIANGULATIONS.format(n=5_000_000, threads=threads), seconds_before)


@pytest.fixture
def interrupts_raise():
    """Programs that a shell starts in the background begin with SIGINT ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_an_interrupt_while_the_core_is_loaded_waits(interrupts_raise):
    done = []

    def load():
        with hold_interrupts():
            signal.raise_signal(signal.SIGINT)
            done.append("loaded")

    with pytest.raises(KeyboardInterrupt):
        load()
    assert done == ["loaded"]
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)


INSIDE = """
import threading, time
import numpy as np
import tinsmith as ts
points = np.random.default_rng(0).random((20000, 3))
tin = ts.triangulate(points)
def go():
    while True:
        {call}
threading.Thread(target=go, daemon=True).start()
time.sleep(0.2)
"""


@pytest.mark.parametrize("again", list_seeds(3, few=1))
@pytest.mark.parametrize(
    "call",
    [
        "ts.triangulate(points, threads=2)",
        "ts.contours(tin, interval=0.1)",
        "tin.interpolate(points[:, :2])",
        "ts.volume(tin, base=0.5, progress=lambda done: None)",
    ],
)
def test_the_interpreter_exits_while_a_daemon_thread_is_inside(call, again):
    done = subprocess.run([sys.executable, "-c", INSIDE.format(call=call)], capture_output=True)
    assert (done.returncode, done.stderr) == (0, b"")


@pytest.mark.parametrize("name", ["numpy.ma", "shapely"])
@pytest.mark.parametrize("has", [(), ("Geometry",)])
def test_a_module_that_another_thread_is_importing_does_no_harm(name, has, monkeypatch):
    """It is listed already, with some of its names."""
    tin = ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.0]])
    half = type(sys)(name)
    for one in has:
        setattr(half, one, type(one, (), {}))
    monkeypatch.setitem(sys.modules, name, half)
    tin.move(0, [0.1, 0.1, 1.0])
    assert tin.interpolate([[0.5, 0.5]]).shape == (1,)
    assert len(ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]])) == 1
    assert len(ts.triangulate([[0, 0, 0], [1, 0, 0], [0, 1, 0]], breaklines=[[[0, 0], [0, 1]]]))
