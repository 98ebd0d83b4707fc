"""What ``tinsmith info`` says and draws of the shapes of triangles."""

import io
import json

import numpy as np
import pytest
from support.commands import run_command as run

import tinsmith as ts
from tinsmith.terrain import histogram
from tinsmith.tin import quality

PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture
def surface(tmp_path, monkeypatch):
    """Be in a folder with a TIN of 300 points in a CRS of metres."""
    monkeypatch.chdir(tmp_path)
    points = np.random.default_rng(2).uniform(0, 100, (300, 3)) + np.array([742_000, 4_030_000, 0])
    tin = ts.triangulate(points, crs="EPSG:32616")
    ts.write(tin, "surface.ply")
    return tin


def size_of_png(path):
    data = path.read_bytes()
    assert data.startswith(PNG)
    assert data.endswith(b"IEND\xaeB`\x82")
    return int.from_bytes(data[16:20]), int.from_bytes(data[20:24])


# ------------------------------------------------------------------ info


def test_info_tells_the_quality_of_a_tin(surface):
    shown = run("info", "surface.ply").stdout
    found = quality(surface)
    share = 100 * (found.min_angle < 20).mean()
    assert f"worst {found.min_angle.min():.2g}°, below 20° in {share:.1f} % of triangles" in shown
    assert f"aspect ratio: median {np.sort(found.aspect_ratio)[len(found) // 2]:.2f}" in shown


def test_info_as_json_has_the_summary(surface):
    facts = json.loads(run("info", "surface.ply", "--json").stdout)
    assert facts["quality"] == quality(surface).summary()
    assert "plot" not in facts


def test_info_of_points_has_no_quality(surface, tmp_path):
    (tmp_path / "points.csv").write_text("0,0,1\n4,0,2\n0,3,3\n")
    assert "quality" not in json.loads(run("info", "points.csv", "--json").stdout)


def test_in_degrees_there_is_no_quality_and_no_plot(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    points = [[-84.2, 36.1, 300], [-84.1, 36.1, 310], [-84.1, 36.2, 320]]
    ts.write(ts.triangulate(points, crs="EPSG:4326"), "degrees.ply")
    assert json.loads(run("info", "degrees.ply", "--json").stdout)["quality"] is None
    assert "Quality" not in run("info", "degrees.ply").stdout
    refused = run("info", "degrees.ply", "--plot", "plot.png", code=1)
    assert "are degrees" in refused.stderr
    assert not (tmp_path / "plot.png").exists()


# ------------------------------------------------------------------ --plot


def test_plot_writes_a_picture_and_says_so(surface, tmp_path):
    pytest.importorskip("matplotlib")
    shown = run("info", "surface.ply", "--plot", "plot.png").stdout
    assert "Written     plot.png (" in shown
    assert size_of_png(tmp_path / "plot.png") == (1650, 1050)
    assert {path.name for path in tmp_path.iterdir()} == {"plot.png", "surface.ply"}
    first = (tmp_path / "plot.png").read_bytes()
    facts = json.loads(run("info", "surface.ply", "--plot", "plot.png", "--json").stdout)
    assert facts["plot"] == "plot.png"
    assert (tmp_path / "plot.png").read_bytes() == first


@pytest.mark.parametrize(
    ("name", "says", "code"),
    [
        ("plot.gif", "its name must end in .png", 2),
        ("plot", "its name must end in .png", 2),
        ("surface.ply", "is the input", 2),
        ("nowhere/plot.png", "there is no folder 'nowhere'", 1),
    ],
)
def test_plot_that_cannot_be_written_is_one_sentence(surface, tmp_path, name, says, code):
    pytest.importorskip("matplotlib")
    before = (tmp_path / "surface.ply").read_bytes()
    result = run("info", "surface.ply", "--plot", name, code=code)
    assert says in result.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["surface.ply"]
    assert (tmp_path / "surface.ply").read_bytes() == before


def test_plot_of_points_needs_a_tin(surface, tmp_path):
    (tmp_path / "points.csv").write_text("0,0,1\n4,0,2\n0,3,3\n")
    result = run("info", "points.csv", "--plot", "plot.png", code=1)
    assert "'points.csv' holds points, and --plot needs a TIN" in result.stderr
    assert not (tmp_path / "plot.png").exists()


def test_a_failed_plot_leaves_the_old_picture(surface, tmp_path, monkeypatch):
    figure = pytest.importorskip("matplotlib.figure")
    (tmp_path / "plot.png").write_bytes(b"old")

    def fail(self, file, **_):
        file.write(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(figure.Figure, "savefig", fail)
    result = run("info", "surface.ply", "--plot", "plot.png", code=1)
    assert "No space left on device" in result.stderr
    assert (tmp_path / "plot.png").read_bytes() == b"old"
    assert {path.name for path in tmp_path.iterdir()} == {"plot.png", "surface.ply"}


# ------------------------------------------------------------------ the histogram


def bars(axes):
    return axes.patches[0].get_data()


def test_bars_are_the_shares_of_triangles(surface):
    pytest.importorskip("matplotlib")
    found = quality(surface)
    small, large, aspect, length = histogram(found, unit="m").axes
    shares, edges, _ = bars(small)
    assert (edges[0], edges[-1]) == (0, 60)
    for low, high, share in zip(edges[:-1], edges[1:], shares, strict=True):
        inside = (found.min_angle >= low) & (found.min_angle < high)
        assert share == pytest.approx(100 * inside.mean())
    for axes in (small, large):
        assert bars(axes)[0].sum() == pytest.approx(100)
    for axes, values in ((aspect, found.aspect_ratio), (length, found.edge_lengths)):
        shares, edges, _ = bars(axes)
        inside = (values >= edges[0]) & (values <= edges[-1])
        assert shares.sum() == pytest.approx(100 * inside.mean())
        assert inside.mean() >= 0.995


def test_bars_of_one_triangle_and_of_a_raster_are_whole():
    pytest.importorskip("matplotlib")
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(4.0), np.arange(4.0)))
    raster = ts.triangulate(np.stack([x, y, x], axis=1))
    for tin in (ts.TIN.from_triangles([[0, 0, 0], [4, 0, 0], [0, 3, 0]], [[0, 1, 2]]), raster):
        figure = histogram(quality(tin, space=True), title="A $title$ of\nours")
        assert figure.get_suptitle() == "A $title$ of ours"
        assert [bars(axes)[0].sum() for axes in figure.axes] == pytest.approx([100] * 4)


def test_triangles_without_area_do_not_break_the_histogram():
    pytest.importorskip("matplotlib")
    far = 2.0**30
    flat = [[0, 0, 0], [far, far - 1, 0], [2 * far + 1, 2 * far - 1, 0]]
    tin = ts.TIN.from_triangles(flat, [[0, 1, 2]])
    assert quality(tin).aspect_ratio[0] == np.inf
    figure = histogram(quality(tin))
    assert bars(figure.axes[0])[0][0] == 100
    picture = io.BytesIO()
    figure.savefig(picture, format="png")
    assert picture.getvalue().startswith(PNG)
