"""Tasks on a Dask cluster, one of whose workers is killed."""

from __future__ import annotations

import os
import signal
import threading
import time

import distributed
import pytest

import tinsmith as ts
from tinsmith.tiled.running.executors import connect_to_dask, run_tasks


def square(job):
    """Return a square, after a while."""
    time.sleep(0.1)
    return job * job


@pytest.mark.filterwarnings("ignore")  # of distributed, about a worker that is gone
@pytest.mark.slow
def test_a_cluster_does_every_job_though_a_worker_is_killed():
    taken = {}
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50
    ) as cluster:
        worker = next(iter(cluster.workers.values()))
        threading.Timer(1.0, os.kill, (worker.pid, signal.SIGKILL)).start()
        with connect_to_dask(cluster.scheduler_address) as executor:
            run_tasks(
                executor,
                square,
                range(40),
                workers=2,
                take=lambda job, result: taken.__setitem__(job, result),
                give_up=lambda job, sentence: pytest.fail(sentence),
            )
    assert taken == {job: job * job for job in range(40)}


@pytest.mark.filterwarnings("ignore")
def test_no_scheduler_is_a_sentence(monkeypatch):
    monkeypatch.setattr("tinsmith.tiled.running.executors._SECONDS_TO_CONNECT", 1)
    with (
        pytest.raises(
            ts.ReadError, match=r"No scheduler of Dask answers at 'tcp://127\.0\.0\.1:9'"
        ),
        connect_to_dask("tcp://127.0.0.1:9"),
    ):
        pass
