"""What tests of many files share: a folder of lidar, and its surface in memory."""

from __future__ import annotations

import pytest
from support.many_files import KeptProcesses, write_lidar

import tinsmith as ts


@pytest.fixture(scope="session", autouse=True)
def kept_processes():
    """Use the processes of one call for the next."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("tinsmith.tiled.running.run_options.Processes", KeptProcesses)
        yield
    KeptProcesses.end()


@pytest.fixture(scope="module")
def lidar(tmp_path_factory):
    """Return a folder of tiles that overlap, with points at one place and of two classes."""
    return write_lidar(tmp_path_factory.mktemp("lidar"))


@pytest.fixture(scope="module")
def tin(lidar):
    """Return the surface in memory."""
    return ts.triangulate(ts.read(lidar, classes=2))
