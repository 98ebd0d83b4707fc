"""Lines in PLY files: names and kinds come back; faults in what the header tells are refused."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts

NAMES = ['a "kerb" \\ of\nTübingen', "", "comment edges: constrained", "pond"]


def make_tin(seed=1):
    points = np.random.default_rng(seed).integers(0, 60, (300, 3)).astype(float)
    return ts.triangulate(
        points,
        breaklines=[
            ts.Breakline([[1, 1, 3], [50, 40, 5.0]], name=NAMES[0]),
            ts.Breakline([[1, 50], [55, 2.0]], kind="soft", name=NAMES[1]),
            ts.Breakline([[5, 30, 1], [45, 31, 3]], name=NAMES[2]),
        ],
        water=[ts.Water([[10, 10], [20, 10], [20, 20], [10, 20]], 0.1, name=NAMES[3])],
        boundary=[[[0, 0], [58, 0], [58, 58], [0, 58]]],
        holes=[[[40, 45], [50, 45], [45, 52]]],
        crs="EPSG:32616",
    )


@pytest.fixture
def path(tmp_path):
    return tmp_path / "a.ply"


@pytest.mark.parametrize("seed", range(5))
def test_lines_come_back(path, seed):
    tin = make_tin(seed)
    found = ts.read(ts.write(tin, path))
    for name in ("points", "triangles", "neighbors", "constrained"):
        assert getattr(found, name).tobytes() == getattr(tin, name).tobytes()
    for name in ("vertices", "offsets", "sources"):
        ours, theirs = getattr(tin.lines, name), getattr(found.lines, name)
        assert (theirs.dtype, theirs.tolist()) == (ours.dtype, ours.tolist())
    assert (found.lines.kinds, found.lines.names) == (tin.lines.kinds, tin.lines.names)
    assert ts.check(found).ok
    assert path.read_bytes() == ts.write(found, path.with_name("b.ply")).read_bytes()


def test_edges_of_other_programs_are_no_lines(path):
    path.write_text(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
        "property double z\nelement face 1\nproperty list uchar int vertex_indices\n"
        "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
        "end_header\n0 0 1\n4 0 2\n0 3 3\n3 0 1 2\n0 1\n"
    )
    found = ts.read(path)
    assert not found.constrained.any()
    assert len(found.lines) == 0


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        (b"comment line: hard", b"comment line: herd", "tells no line"),
        (b'"pond"', b'"pond', "tells no line"),
        (b"comment line: hard 0", b"comment line: hard 2147483648", "tells no line"),
        (b'1 "pond"', b'10 "pond"', "edges, and there are"),
        (b'1 "pond"', b'0 "pond"', "its lines have"),
        (b"property int vertex1", b"property int vertex3", "without vertex1 and vertex2"),
        (b"\x00\x00\x00\x00\x01\x00\x00\x00", b"\x00\x00\x00\x00\x09\x00\x00\x00", "edge 0"),
        (b"\x00\x00\x00\x00\x01\x00\x00\x00", b"\x01\x00\x00\x00\x02\x00\x00\x00", "edge 1"),
        (b"\x00\x00\x00\x00\x01\x00\x00\x00", b"\x01\x00\x00\x00\x03\x00\x00\x00", "no edge of a"),
    ],
)
def test_faults_are_refused(path, old, new, reason):
    corners = [[0, 0, 1], [4, 0, 2], [4, 4, 3], [0, 5, 4.0]]
    tin = ts.triangulate(corners, breaklines=[ts.Breakline(corners[:2], name="pond")])
    if reason == "edge 1":
        tin = ts.triangulate(corners, breaklines=[ts.Breakline(corners[:3], name="pond")])
    content = ts.write(tin, path).read_bytes()
    assert content.count(old) >= 1
    head, _, body = content.rpartition(old)
    path.write_bytes(head + new + body)
    with pytest.raises(ts.ReadError) as caught:
        ts.read(path)
    assert reason in str(caught.value)
    assert "a.ply" in str(caught.value)


def test_a_line_of_a_source_below_0_is_no_line(path):
    ts.write(make_tin(), path)
    content = path.read_bytes()
    assert b"line: hard 0 " in content
    path.write_bytes(content.replace(b"line: hard 0 ", b"line: hard -1 ", 1))
    try:
        found = ts.read(path)
    except ts.ReadError:
        return
    assert ts.check(found, level=2).ok
