"""What is refused as a raster whose rows are read as they are asked for."""

from __future__ import annotations

import os

import pytest

import tinsmith as ts


def test_a_pipe_is_refused_before_it_is_opened(tmp_path):
    os.mkfifo(tmp_path / "ground.tif")
    with pytest.raises(ts.ReadError, match=r"ground.tif' is a pipe.*write it to a file"):
        ts.read_raster(tmp_path / "ground.tif")


@pytest.mark.parametrize(("name", "words"), [("none.tif", "no file"), ("", "Is a directory")])
def test_what_is_no_file_is_refused(tmp_path, name, words):
    with pytest.raises(ts.ReadError, match=words):
        ts.read_raster(tmp_path / name)


@pytest.mark.parametrize("path", [None, 7, [1.0, 2.0], b"a.tif"])
def test_what_is_no_path_is_refused(path):
    with pytest.raises(ts.OptionError, match="the name of a file, as text or Path"):
        ts.read_raster(path)
