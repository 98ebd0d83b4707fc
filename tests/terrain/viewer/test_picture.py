"""Pictures: what is in them, what is written on them, and what is said when there is none."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image
from support.pictures import make_dipping_plane, read_pixels

from tinsmith import TIN, MissingExtraError, triangulate
from tinsmith.base.crs import FOOT, METRE
from tinsmith.base.georeference.scales import NOT_KNOWN, find_ground
from tinsmith.terrain import OptionError, RenderError, preview, slope
from tinsmith.terrain.drawing import make_scale_bar
from tinsmith.terrain.drawing.palette import compute_lightness, interpolate_tints
from tinsmith.terrain.drawing.rounding import choose_ticks, format_number, round_down
from tinsmith.terrain.viewer import opengl
from tinsmith.terrain.viewer.annotations import BAR_WIDTH, Layout
from tinsmith.terrain.viewer.picture import PICTURE_SUFFIXES
from tinsmith.terrain.viewer.relief import choose_exaggeration, measure_relief

pv = pytest.importorskip("pyvista")

WHITE = (255, 255, 255)
TINTS = [[77, 115, 93], [112, 147, 100], [173, 172, 108], [223, 197, 153], [243, 233, 223]]


def find_exaggeration(tin):
    ground = find_ground(tin)
    return choose_exaggeration(tin, ground, measure_relief(tin, ground))


def hill(*, crs="EPSG:32616", relief=30.0, steps=25, extent=240.0):
    """A round hill on a square grid at UTM coordinates."""
    axis = np.linspace(0.0, extent, steps)
    x, y = (part.ravel() for part in np.meshgrid(axis, axis))
    away = np.hypot(x - extent / 2, y - extent / 2) / extent
    z = 200.0 + relief * np.exp(-((4 * away) ** 2))
    return triangulate(np.column_stack([742_000 + x, 4_030_000 + y, z]), crs=crs)


def in_frame(pixels):
    """The part of a picture in which only terrain is drawn."""
    height, width = pixels.shape[:2]
    factor = min(width / 1600, height / 1000)
    frame = Layout(width / factor, height / factor).frame
    bottom, top = (height - factor * side for side in (frame.ymin, frame.ymax))
    return pixels[
        round(top) : round(bottom), round(factor * frame.xmin) : round(factor * frame.xmax)
    ]


def is_colored(pixels):
    """Which pixels are tinted, neither white nor grey."""
    return np.ptp(pixels.astype(int), axis=-1) > 24


# ------------------------------------------------------------------ the picture


@pytest.mark.usefixtures("can_draw")
class TestPicture:
    @pytest.mark.parametrize("size", [(640, 400), (400, 640)])
    def test_it_has_the_size_asked_for_and_shows_terrain_on_paper(self, tmp_path, size):
        path = preview(hill(), output=tmp_path / "hill.png", size=size)
        assert path == tmp_path / "hill.png"
        pixels = read_pixels(path)
        assert pixels.shape == (size[1], size[0], 3)
        share = is_colored(pixels).mean()
        assert 0.1 < share < 0.8
        assert len(np.unique(in_frame(pixels).reshape(-1, 3), axis=0)) > 500
        for edge in (pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]):
            assert (edge == WHITE).all()

    def test_terrain_stays_clear_of_the_annotations(self, tmp_path):
        tin = hill(relief=200.0)
        bare = read_pixels(preview(tin, output=tmp_path / "a.png", size=(800, 500)))
        height, width = bare.shape[:2]
        frame = Layout(1600, 1000).frame
        header = bare[: int(height - frame.ymax / 2) - 3]
        assert not is_colored(header).any()
        footer = bare[int(height - frame.ymin / 2) + 3 :]
        legend = is_colored(footer)
        assert legend[:, width * 2 // 3 :].any()
        assert not legend[:, : width * 2 // 3].any()

    def test_title_and_counts_are_written(self, tmp_path):
        named = read_pixels(
            preview(hill(), output=tmp_path / "a.png", size=(800, 500), title="North")
        )
        other = read_pixels(
            preview(hill(), output=tmp_path / "b.png", size=(800, 500), title="South")
        )
        differ = (named != other).any(axis=2)
        rows = np.flatnonzero(differ.any(axis=1))
        assert len(rows)
        assert rows.max() < 50
        assert (named[10:50, :400] != 255).any()

    @pytest.mark.parametrize("title", ["$x^2$ | 5", "Größe\nPlatz", "Пример", "x" * 400])
    def test_any_title_can_be_written(self, tmp_path, title):
        path = preview(hill(steps=4), output=tmp_path / "a.png", size=(400, 250), title=title)
        pixels = read_pixels(path)
        assert (pixels[5:25] != 255).any()
        assert (pixels[:30, -10:] == 255).all()

    def test_edges_are_drawn_darker(self, tmp_path):
        plain = read_pixels(preview(hill(), output=tmp_path / "a.png", size=(640, 400)))
        meshed = read_pixels(
            preview(hill(), output=tmp_path / "b.png", size=(640, 400), edges=True)
        )
        surface = is_colored(in_frame(plain))
        change = in_frame(meshed).astype(int) - in_frame(plain)
        assert change[surface].mean() < -3

    def test_breaklines_are_drawn_heavier(self, tmp_path):
        tin = hill(steps=6)
        flags = np.ones((len(tin.triangles), 3), bool)
        broken = TIN.from_triangles(tin.points, tin.triangles, constrained=flags, crs=tin.crs)
        plain = read_pixels(preview(tin, output=tmp_path / "a.png", size=(640, 400), edges=True))
        heavy = read_pixels(preview(broken, output=tmp_path / "b.png", size=(640, 400), edges=True))
        assert heavy.mean() < plain.mean()

    def test_it_is_reproducible(self, tmp_path):
        first = preview(hill(), output=tmp_path / "a.png", size=(640, 400))
        second = preview(hill(), output=tmp_path / "b.png", size=(640, 400))
        assert first.read_bytes() == second.read_bytes()

    def test_seen_from_above_a_square_is_a_square(self, tmp_path):
        path = preview(hill(), output=tmp_path / "a.png", size=(800, 500), view="top")
        tinted = is_colored(in_frame(read_pixels(path)))
        height, width = (np.ptp(np.flatnonzero(tinted.any(axis=k))) for k in (1, 0))
        assert height == pytest.approx(width, abs=2)
        assert height == pytest.approx(Layout(1600, 1000).frame.height / 2, abs=3)

    def test_light_comes_from_the_northwest(self, tmp_path):
        brightness = {}
        for azimuth in (315, 135, 45, 225):
            tin = make_dipping_plane(azimuth)
            path = preview(tin, output=tmp_path / f"{azimuth}.png", size=(400, 250), view="top")
            pixels = in_frame(read_pixels(path))
            brightness[azimuth] = pixels[is_colored(pixels)].mean()
        assert brightness[315] == max(brightness.values())
        assert brightness[135] == min(brightness.values())

    def test_level_ground_is_drawn_in_one_tint(self, tmp_path):
        tin = triangulate([[0, 0, 5], [9, 0, 5], [9, 9, 5], [0, 9, 5]])
        path = preview(tin, output=tmp_path / "a.png", size=(400, 250), view="top")
        center = read_pixels(path)[115:125, 195:205].reshape(-1, 3)
        assert (center == center[0]).all()
        assert np.abs(center[0].astype(int) - interpolate_tints(257)[128]).max() <= 6

    def test_higher_ground_is_lighter(self, tmp_path):
        tin = triangulate([[0, 0, 0], [200, 0, 0], [200, 200, 1], [0, 200, 1]])
        path = preview(tin, output=tmp_path / "a.png", size=(400, 250), view="top", exaggeration=1)
        column = in_frame(read_pixels(path))
        column = column[5:-5, column.shape[1] // 2]
        light = compute_lightness(column)
        assert light[0] > light[-1] + 0.3
        assert (np.diff(light) <= 0.004).all()

    def test_a_single_triangle_and_an_unknown_crs_make_a_picture(self, tmp_path):
        tin = triangulate([[0, 0, 1], [1, 0, 2], [0, 1, 3]], crs=None)
        assert is_colored(
            read_pixels(preview(tin, output=tmp_path / "a.png", size=(400, 250)))
        ).any()

    def test_jpeg_and_tiff_are_written_too(self, tmp_path):
        for suffix, kind in ((".jpg", "JPEG"), (".TIFF", "TIFF")):
            path = preview(hill(steps=4), output=tmp_path / f"a{suffix}", size=(400, 250))
            with Image.open(path) as image:
                assert (image.format, image.size) == (kind, (400, 250))

    def test_a_failed_write_leaves_the_old_picture(self, tmp_path, monkeypatch):
        path = tmp_path / "a.png"
        path.write_bytes(b"old")

        def full(self, target, **options):
            target.write_bytes(b"half")
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(Image.Image, "save", full)
        with pytest.raises(RenderError, match=": No space left on device"):
            preview(hill(steps=4), output=path, size=(400, 250))
        assert path.read_bytes() == b"old"
        assert list(tmp_path.iterdir()) == [path]

    def test_annotations_follow_the_camera(self, monkeypatch):
        module = sys.modules["tinsmith.terrain.viewer.scene"]
        written = []
        monkeypatch.setattr(opengl, "require_window", lambda: None)
        monkeypatch.setattr(opengl, "require_on_screen", lambda kind: None)
        monkeypatch.setattr(
            module.Overlay, "draw_text", lambda self, place, words, *_, **__: written.append(words)
        )
        plotter = pv.Plotter

        def off_screen_plotter(*, off_screen, **options):
            assert not off_screen  # a window
            return plotter(off_screen=True, **options)

        def turned(self, **_):
            assert "Parallel view from the south-southwest, 35° above the horizon" in written
            assert "50" in written
            written.clear()
            self.camera.parallel_scale /= 10
            assert "5" in written
            written.clear()
            self.view_xy()
            assert "Map view, north up" in written

        monkeypatch.setattr(pv, "Plotter", off_screen_plotter)
        monkeypatch.setattr(plotter, "show", turned)
        preview(hill(), size=(800, 500)).show()


def test_large_coordinates_do_not_shake_the_picture(tmp_path, can_draw):
    near = hill()
    low = near.points.min(axis=0) * (1, 1, 0)
    shifted = TIN.from_triangles(near.points - low, near.triangles, crs=near.crs)
    first = read_pixels(preview(near, output=tmp_path / "a.png", size=(400, 250)))
    second = read_pixels(preview(shifted, output=tmp_path / "b.png", size=(400, 250)))
    assert np.abs(first.astype(int) - second).mean() < 0.2


# ------------------------------------------------------------------ no picture


@pytest.mark.parametrize("name", ["a.pdf", "a.gltf", "a", "png"])
def test_another_suffix_is_refused_with_the_list_of_those_allowed(tmp_path, name):
    with pytest.raises(RenderError) as caught:
        preview(hill(steps=3), output=tmp_path / name)
    assert all(suffix in str(caught.value) for suffix in PICTURE_SUFFIXES)


def test_a_missing_folder_is_named(tmp_path):
    with pytest.raises(RenderError, match=r"there is no folder '.*nowhere'"):
        preview(hill(steps=3), output=tmp_path / "nowhere" / "a.png")


@pytest.mark.parametrize(
    "options",
    [
        {"view": "side"},
        {"size": (0, 100)},
        {"size": (100_000, 800)},
        {"size": (800.5, 800)},
        {"size": (800,)},
        {"exaggeration": 0},
        {"exaggeration": float("nan")},
    ],
)
def test_options_out_of_range_are_refused(tmp_path, options):
    with pytest.raises(OptionError) as caught:
        preview(hill(steps=3), output=tmp_path / "a.png", **options)
    assert caught.value.option in options
    assert not list(tmp_path.iterdir())


def test_without_pyvista_the_extra_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(MissingExtraError, match=r"A preview needs pyvista.*pip install pyvista"):
        preview(hill(steps=3), output=tmp_path / "a.png")


@pytest.fixture
def fresh_probe():
    """Forget what the probe said, before and after."""
    opengl._find_window_class.cache_clear()
    yield
    opengl._find_window_class.cache_clear()


@pytest.mark.usefixtures("fresh_probe")
@pytest.mark.parametrize(
    "probe",
    [
        "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)",
        "raise ImportError('libGL.so.1: cannot open shared object file')",
        "print('nothing to say')",
        "import time; time.sleep(60)",
    ],
    ids=["segfault", "error", "silence", "hanging"],
)
def test_a_machine_that_cannot_draw_gets_a_sentence(tmp_path, monkeypatch, probe):
    monkeypatch.setattr(opengl, "_PROBE", probe)
    if "sleep" in probe:
        monkeypatch.setattr(opengl, "PROBE_SECONDS", 0.5)
    with pytest.raises(RenderError, match="libegl1 libgl1-mesa-dri"):
        preview(hill(steps=3), output=tmp_path / "a.png")
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("fresh_probe")
def test_the_probe_runs_once(monkeypatch):
    runs = []

    def run(command, **options):
        runs.append(command)
        return subprocess.CompletedProcess(command, 0, stdout="window:vtkEGLRenderWindow\n")

    monkeypatch.setattr(opengl.subprocess, "run", run)
    opengl.require_opengl()
    opengl.require_opengl()
    assert len(runs) == 1
    assert runs[0][0] == sys.executable


@pytest.mark.usefixtures("can_draw")
def test_without_a_display_a_window_is_refused(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    if not sys.platform.startswith("linux"):
        pytest.skip("other systems have a display or say so themselves")
    with pytest.raises(RenderError, match=r"no display.*name a picture file as output"):
        preview(hill(steps=3)).show()


@pytest.mark.slow
@pytest.mark.usefixtures("can_draw")
def test_another_process_draws_without_a_word_on_stderr(tmp_path):
    code = (
        "import sys, tinsmith as ts\n"
        "tin = ts.triangulate([[0, 0, 1], [4, 0, 2], [4, 3, 3], [0, 3, 4]])\n"
        "assert 'pyvista' not in sys.modules\n"
        "ts.terrain.preview(tin, output='a.png', size=(400, 250))\n"
    )
    environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


# ------------------------------------------------------------------ scale and exaggeration


@pytest.mark.parametrize(
    ("relief", "expected"), [(0.0, 1), (60, 1), (24, 1), (23, 1.5), (12, 2), (5, 5), (0.9, 30)]
)
def test_the_exaggeration_lifts_the_relief_to_a_tenth_of_the_extent(relief, expected):
    tin = make_dipping_plane(0, steepness=relief / 240, extent=240.0)
    assert find_exaggeration(tin) == expected


@pytest.mark.parametrize("relief", np.geomspace(0.25, 24.0, 12))
def test_a_chosen_exaggeration_is_not_too_much(relief):
    tin = make_dipping_plane(90, steepness=relief / 240, extent=240.0)
    drawn = find_exaggeration(tin) * np.ptp(tin.points[:, 2])
    assert drawn >= 24.0 * (1 - 1e-9)
    assert drawn <= 48.0 * (1 + 1e-9)


@pytest.mark.parametrize(
    ("unit", "pixels", "expected"),
    [
        (METRE, 2.0, (100.0, "100", "m")),
        (METRE, 0.05, (5000.0, "5", "km")),
        (METRE, 900.0, (0.2, "0.2", "m")),
        (FOOT, 0.05, (5000.0, "5,000", "ft")),
        (NOT_KNOWN, 1.0, (200.0, "200", "")),
    ],
)
def test_the_scale_bar_has_a_round_length(unit, pixels, expected):
    bar = make_scale_bar(unit, BAR_WIDTH / pixels)
    assert (bar.length, bar.labels[-1][1], bar.symbol) == expected


# ------------------------------------------------------------------ units


@pytest.mark.parametrize(
    ("crs", "name", "unit", "elevation_unit", "scale"),
    [
        ("EPSG:32616", "WGS 84 / UTM zone 16N (EPSG:32616)", "m", "m", 1.0),
        ("EPSG:2264", "NAD83 / North Carolina (ftUS) (EPSG:2264)", "US ft", "US ft", 1.0),
        ("EPSG:2264+5703", None, "US ft", "m", 3937 / 1200),
        ("EPSG:32616+6360", None, "m", "US ft", 1200 / 3937),
        (None, "CRS unknown", "", "", 1.0),
    ],
)
def test_units_come_from_the_crs(crs, name, unit, elevation_unit, scale):
    ground = find_ground(hill(crs=crs, steps=3))
    assert (ground.unit.symbol, ground.elevation_unit.symbol) == (unit, elevation_unit)
    assert ground.scale == pytest.approx((1.0, 1.0, scale))
    assert name in (None, ground.crs_name)


@pytest.mark.parametrize("latitude", [-42.0, 0.0, 36.5, 70.0])
def test_degrees_are_drawn_as_long_as_they_are(latitude):
    from pyproj import Geod

    corners = np.array([(10, -0.005), (10.01, -0.005), (10.01, 0.005), (10, 0.005)])
    corners[:, 1] += latitude
    tin = triangulate(np.column_stack([corners, [1, 2, 3, 4]]), crs="EPSG:4326")
    ground, geod = find_ground(tin), Geod(ellps="WGS84")
    east = geod.inv(10, latitude, 10.01, latitude)[2] / 0.01
    north = geod.inv(10, latitude - 0.005, 10, latitude + 0.005)[2] / 0.01
    assert ground.scale == pytest.approx((east, north, 1.0), rel=1e-6)
    assert ground.unit == ground.elevation_unit == METRE


# ------------------------------------------------------------------ tints and round numbers


def test_lightness_rises_evenly_with_elevation():
    light = compute_lightness(interpolate_tints(32))
    steps = np.diff(light)
    np.testing.assert_allclose(steps, steps.mean(), atol=0.004)
    assert light[0] < 0.55
    assert light[-1] > 0.9


def test_lightness_of_black_white_and_grey():
    # CSS Color 4: the mid grey #808080 has Oklab lightness 0.5999.
    grey = np.array([[0] * 3, [128] * 3, [255] * 3], np.uint8)
    np.testing.assert_allclose(compute_lightness(grey), [0.0, 0.5999, 1.0], atol=1e-3)


def test_tints_go_from_moss_green_to_limestone():
    assert interpolate_tints(5).tolist() == TINTS
    assert interpolate_tints(2).tolist() == [TINTS[0], TINTS[-1]]
    np.testing.assert_array_equal(interpolate_tints(256)[[0, 255]], [TINTS[0], TINTS[-1]])


def test_no_tint_looks_like_water():
    red, green, blue = interpolate_tints().astype(int).T
    assert (blue < np.maximum(red, green)).all()


@pytest.mark.parametrize(
    ("value", "expected"),
    [(1.0, 1.0), (1.99, 1.0), (2, 2), (4.9, 2), (5, 5), (99, 50), (1e-3, 1e-3), (0.3, 0.2)],
)
def test_lengths_are_rounded_down_to_one_two_five(value, expected):
    assert round_down(value) == pytest.approx(expected)


def test_what_is_round_but_for_rounding_stays():
    assert round_down(20 - 1e-12) == 20.0  # but for rounding


@pytest.mark.parametrize(("low", "high"), [(0, 971), (211.3, 220.5), (-5, 5), (1e-3, 2e-3)])
def test_ticks_are_within_evenly_spaced_and_few(low, high):
    values = np.array(choose_ticks(low, high, count=5))
    assert low <= values[0]
    assert values[-1] <= high
    assert 3 <= len(values) <= 10
    np.testing.assert_allclose(np.diff(values), np.diff(values)[0], rtol=1e-9)


def test_level_ground_has_no_ticks():
    assert choose_ticks(5.0, 5.0, count=5) == []


@pytest.mark.parametrize(
    ("value", "step", "words"),
    [(1076, 20, "1,076"), (220.53, 0.2, "220.5"), (2.5, 2.5, "2.5"), (0.25, 0.25, "0.25")],
)
def test_numbers_have_the_decimals_of_their_step(value, step, words):
    assert format_number(value, step=step) == words


def test_an_exaggerated_picture_leaves_the_slope_true(tmp_path, can_draw):
    tin = make_dipping_plane(90, steepness=1.0)
    before = slope(tin)
    preview(tin, output=tmp_path / "a.png", size=(400, 250), exaggeration=5)
    np.testing.assert_array_equal(slope(tin), before)


@pytest.mark.parametrize(
    ("window", "display", "platform", "is_refused"),
    [
        ("vtkXOpenGLRenderWindow", ":0", "linux", False),
        ("vtkXOpenGLRenderWindow", "", "linux", True),
        ("vtkXOpenGLRenderWindow", None, "linux2", True),
        ("vtkCocoaRenderWindow", None, "darwin", False),
        ("vtkWin32OpenGLRenderWindow", None, "win32", False),
        ("vtkEGLRenderWindow", ":0", "linux", True),
        ("vtkOSOpenGLRenderWindow", ":0", "darwin", True),
    ],
)
def test_a_window_needs_a_display(monkeypatch, window, display, platform, is_refused):
    monkeypatch.setattr(opengl, "_find_window_class", lambda: window)
    monkeypatch.setattr(opengl.sys, "platform", platform)
    monkeypatch.delenv("DISPLAY", raising=False)
    if display is not None:
        monkeypatch.setenv("DISPLAY", display)
    if is_refused:
        with pytest.raises(RenderError, match="no display to open a window on"):
            opengl.require_window()
    else:
        opengl.require_window()


@pytest.mark.usefixtures("can_draw")
def test_a_display_that_cannot_be_reached_is_none(monkeypatch):
    """VTK then draws where nobody sees it, and comes back at once."""
    monkeypatch.setattr(opengl, "require_window", lambda: None)
    monkeypatch.setenv("DISPLAY", ":987")
    plotter = pv.Plotter
    monkeypatch.setattr(pv, "Plotter", lambda *, off_screen, **k: plotter(off_screen=True, **k))
    monkeypatch.setattr(plotter, "show", lambda self, **_: pytest.fail("a window was opened"))
    with pytest.raises(RenderError, match="no display to open a window on"):
        preview(hill(steps=3), size=(400, 250)).show()


@pytest.mark.usefixtures("fresh_probe")
@pytest.mark.parametrize(
    ("code", "said", "expected"),
    [
        (0, "window:vtkEGLRenderWindow\n", "vtkEGLRenderWindow"),
        (0, "a library says\nwindow:vtkX\n", "vtkX"),
        (0, "nothing", ""),
        (1, "window:vtkX\n", ""),
        (-11, "window:vtkX\n", ""),
    ],
)
def test_the_probe_tells_the_kind_of_window(monkeypatch, code, said, expected):
    def run(command, **options):
        assert options["timeout"] == opengl.PROBE_SECONDS == 60
        return subprocess.CompletedProcess(command, code, stdout=said)

    monkeypatch.setattr(opengl.subprocess, "run", run)
    assert opengl._find_window_class() == expected
