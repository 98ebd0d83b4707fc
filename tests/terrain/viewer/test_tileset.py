"""Tilesets in the page: levels as the view needs them, no holes, what is told, what is refused."""

from __future__ import annotations

import json
import threading
import urllib.error
import urllib.request
import warnings

import numpy as np
import pytest
from pyproj import Transformer
from support import tilesets
from support.pages import open_page, open_served, wait_until
from support.tilesets import make_square_glb, make_tile, write_quadtree, write_tileset

import tinsmith as ts

CORNER = np.array([742_000.0, 4_030_000.0])
IGNORED = "Promise.resolve(1)"
BIG = 16.0


def hill(xy):
    x, y = xy.T - CORNER[:, None]
    return 300 + 20 * np.sin(x / 100) + 10 * np.cos(y / 70)


@pytest.fixture(scope="module")
def terrain(tmp_path_factory):
    """A tileset of this package, and the points of which it is made."""
    folder = tmp_path_factory.mktemp("tileset")
    rng = np.random.default_rng(5)
    xy = np.round(CORNER + rng.random((6000, 2)) * 800, 3)
    points = np.column_stack([xy, np.round(hill(xy), 3)])
    np.savetxt(folder / "a.csv", points, "%.3f", ",", header="x,y,z", comments="")
    cloud = ts.tiles(folder / "a.csv", crs="EPSG:32616", elevation_unit="m")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.LossWarning)
        cloud.write(folder / "terrain", format="3dtiles", node_points=200)
    ts.preview_tileset(folder / "terrain", output=folder / "page.html")
    return folder, ts.triangulate(points, crs="EPSG:32616", elevation_unit="m")


@pytest.fixture(scope="module")
def page(terrain):
    with open_served(terrain[0], "page.html") as page:
        settle(page)
        yield page


def run(page, code):
    return page.evaluate(f"window.terrain.then(async (p) => {{ {code} }})")


def settle(page):
    run(page, "await p.tileset.settle(); p.scene.draw();")


def write_page(folder, **options):
    path = ts.preview_tileset(folder, output=folder / "index.html", **options)
    return path.name


# ------------------------------------------------------------------ what is written


def test_a_page_names_the_tileset_by_its_way(tmp_path):
    write_quadtree(tmp_path / "two words", levels=1)
    (tmp_path / "pages").mkdir()
    shown = ts.preview_tileset(tmp_path / "two words", title="Hill")
    page = shown.save(tmp_path / "pages/a.html").read_text()
    assert '"address":"../two%20words/tileset.json"' in page
    assert "connect-src 'self'" in page
    assert "<title>Hill</title>" in page
    assert "connect-src" not in ts.preview(ts.triangulate(np.eye(3))).to_html()


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("{", "is no tileset: "),
        ("[]", "no 'asset' with a version"),
        ('{"asset": {"version": "2.0"}, "root": {}}', "is 3D Tiles '2.0': 1.0 and 1.1 are shown"),
        ('{"asset": {"version": "1.1"}}', "or no 'root'"),
    ],
)
def test_what_is_no_tileset_is_refused(tmp_path, content, words):
    (tmp_path / "tileset.json").write_text(content)
    with pytest.raises(ts.ReadError, match=words):
        ts.preview_tileset(tmp_path)


def test_a_picture_of_a_tileset_is_refused(tmp_path):
    write_quadtree(tmp_path, levels=1)
    with pytest.raises(ts.RenderError, match="must end in"):
        ts.preview_tileset(tmp_path, output=tmp_path / "a.png")
    with pytest.raises(ts.RenderError, match="there is no folder"):
        ts.preview_tileset(tmp_path, output=tmp_path / "none/a.html")


def test_only_this_machine_and_only_the_folder_are_served(tmp_path):
    write_quadtree(tmp_path / "in", levels=1)
    (tmp_path / "secret.txt").write_text("x")

    def ask(address, **headers):
        request = urllib.request.Request(address, headers=headers)
        try:
            with urllib.request.urlopen(request) as answer:
                return answer.status
        except urllib.error.HTTPError as error:
            return error.code

    with ts.preview_tileset(tmp_path / "in").serve() as address:
        assert address.startswith("http://127.0.0.1:")
        assert ask(address) == 200
        assert ask(f"{address}tileset/tileset.json") == 200
        assert ask(f"{address}tileset/0/0/0.glb") == 200
        for path in ("tileset/", "tileset/0/", "tileset.json", "tileset/../secret.txt",
                     "tileset/%2e%2e/secret.txt", "tileset//../../secret.txt"):  # fmt: skip
            assert ask(address + path) == 404, path
        assert ask(address, Host="example.com") == 403
    with pytest.raises(OSError, match="refused"):
        ask(address)


# ------------------------------------------------------------------ in a browser


@pytest.mark.slow
def test_places_are_those_of_the_surface(page, terrain):
    """Longitude, latitude and height of the finest level are those of the points."""
    for _ in range(14):
        run(page, "p.scene.zoom(1.2);")
    settle(page)
    origin, scale, places, error = run(
        page,
        """const found = [];
      for (let x = 60; x < 900; x += 61) for (let y = 60; y < 700; y += 57) {
        const f = p.scene.pick(x, y);
        if (f !== null) found.push([f.hit.x, f.hit.y, f.hit.z]); }
      return [p.payload.origin, p.payload.scale, found, p.tileset.error];""",
    )
    assert len(places) > 50
    assert error < 0.5
    x, y, z = np.array(places).T
    to_map = Transformer.from_crs("EPSG:4326", "EPSG:32616", always_xy=True)
    east, north = to_map.transform(x / scale[0] + origin[0], y / scale[1] + origin[1])
    truth = terrain[1].interpolate(np.column_stack([east, north]))
    inside = np.isfinite(truth)
    assert inside.sum() > 50
    assert np.abs(truth - z - origin[2])[inside].max() < 0.01 + error
    run(page, "p.lookFromStart();")
    settle(page)


@pytest.mark.slow
def test_words_under_the_pointer_name_the_error_of_the_level(page):
    words = run(page, "p.tool.read(500, 420); return p.tool.readout.textContent;")
    assert "Longitude -84." in words
    assert "Latitude 36." in words
    assert "Ellipsoidal height " in words
    assert "Geometric error of this level " in words
    head = page.inner_text("header")
    assert "3D Tiles 1.1, made from EPSG:32616" in head
    assert "above the ellipsoid of WGS 84" in head
    assert "as if they were" in head  # the note of the writer


@pytest.mark.slow
def test_a_distance_is_that_on_the_ellipsoid_and_measured_anew_on_finer_levels(page, terrain):
    first = run(
        page,
        """p.tool.choose("distance"); await new Promise((done) => setTimeout(done, 300));
      p.tool.mark(380, 260); p.tool.mark(560, 280);
      return document.getElementById("result").textContent;""",
    )
    assert "Measured on the levels shown, geometric error up to " in first
    for _ in range(10):
        run(page, "p.scene.zoom(1.2);")
    settle(page)
    text, ends = run(
        page,
        """const ends = p.tool.marked.map(({ hit: { x, y, z } }) =>
        [x / p.payload.scale[0] + p.payload.origin[0], y / p.payload.scale[1] + p.payload.origin[1],
         z + p.payload.origin[2]]);
      return [document.getElementById("result").textContent, ends];""",
    )
    from pyproj import Geod

    (u0, v0, z0), (u1, v1, z1) = ends
    along = Geod(ellps="WGS84").line_length([u0, u1], [v0, v1])
    assert float(text.split()[1]) == pytest.approx(along, rel=1e-4)
    to_map = Transformer.from_crs("EPSG:4326", "EPSG:32616", always_xy=True)
    truth = terrain[1].interpolate([to_map.transform(u0, v0), to_map.transform(u1, v1)])
    assert np.abs(truth - [z0, z1]).max() < 0.6
    run(page, "p.tool.clear(); p.lookFromStart();")
    settle(page)


@pytest.mark.slow
def test_what_a_tileset_has_not_is_not_shown(page):
    for one in ("surfaces", "comparison", "along"):
        assert page.is_hidden(f"#{one}")
    assert page.is_visible("#area")
    tints = page.eval_on_selector_all("#tint option", "all => all.map((one) => one.value)")
    assert tints == ["elevation", "slope", "aspect", "plain", "given"]


@pytest.mark.slow
def test_the_picture_is_not_blank_and_switches_change_it(page):
    pictures = [run(page, "return p.furniture.takePicture();")]
    for act in (
        'p.legend.setTint("slope")',
        'p.legend.setTint("given")',
        'document.getElementById("edges").click()',
        'document.getElementById("contours").click()',
        "p.settings.setExaggeration(1)",
    ):
        pictures.append(run(page, f"{act}; return p.furniture.takePicture();"))
    assert len(set(pictures)) == len(pictures)
    assert all(len(one) > 20_000 for one in pictures)


@pytest.mark.slow
def test_the_page_waits_for_a_folder_where_it_is_opened_from_a_file(terrain):
    folder = terrain[0]
    with open_page(folder / "page.html", ready=IGNORED) as page:
        page.wait_for_selector("#folder")
        assert "lets no page that is opened from a file read other files" in page.inner_text(
            "#wait"
        )
        page.set_input_files("#folder", folder / "terrain/1")
        wait_until(page, "document.body.innerText.includes('choose the folder that has it')")
        page.set_input_files("#folder", folder / "terrain")
        page.evaluate("window.terrain.then(() => true)")
        settle(page)
        assert run(page, "return p.tileset.surface.parts.length;") > 1
        assert page.is_hidden("#wait")


@pytest.mark.slow
def test_levels_come_one_after_the_other_and_leave_no_hole(tmp_path):
    """A parent stays until all of its children are there."""
    write_quadtree(tmp_path, levels=3, side=256.0)
    late = threading.Event()
    name = write_page(tmp_path)
    with open_served(tmp_path, name, answers={"1/1/1.glb": late}) as page:
        run(page, "p.scene.look(180, 90); for (let k = 0; k < 3; k += 1) p.scene.zoom(1.3);")
        wait_until(
            page,
            "window.terrain.then((p) => p.tileset.root.children.filter((t) => t.state === 'ready')"
            ".length === 3)",
        )
        run(page, "p.scene.draw();")
        assert run(page, "return p.tileset.choice.shown.map((t) => t.depth);") == [0]
        assert "finer ones are coming" in page.inner_text("#tiles")
        late.set()
        settle(page)
        depths = run(page, "return p.tileset.choice.shown.map((t) => t.depth);")
        assert min(depths) >= 1
        assert page.asked.index("tileset.json") < page.asked.index("0/0/0.glb")
        levels = [int(one[0]) for one in page.asked if one.endswith(".glb")]
        assert levels == sorted(levels)


@pytest.mark.slow
def test_a_request_ends_where_its_tile_is_needed_no_more(tmp_path):
    write_quadtree(tmp_path, levels=2, side=256.0)
    late = threading.Event()
    slow = {f"1/{i}/{j}.glb": late for i in (0, 1) for j in (0, 1)}
    with open_served(tmp_path, write_page(tmp_path), answers=slow) as page:
        ended = []
        page.on("requestfailed", lambda one: ended.append(one.url))
        run(page, "p.scene.look(180, 90); for (let k = 0; k < 5; k += 1) p.scene.zoom(1.3);")
        wait_until(page, "window.terrain.then((p) => p.tileset.choice.wanted.length > 0)")
        run(page, "p.scene.move(20, 0); p.scene.draw();")
        states = run(page, "return p.tileset.root.children.map((t) => t.state);")
        assert states == ["none"] * 4
        settle(page)
        assert run(page, "return p.tileset.failures;") == []
        assert len(ended) == 4
        late.set()


@pytest.mark.slow
def test_memory_has_an_end(tmp_path):
    """What is not in view goes first; then coarser tiles have to do. There is never a hole."""
    write_quadtree(tmp_path, levels=5, side=256.0)
    with open_served(tmp_path, write_page(tmp_path)) as page:
        run(page, "p.scene.look(180, 90);")
        settle(page)
        whole = run(page, "return [p.tileset.bytes, p.tileset.choice.shown.length];")
        run(page, "p.tileset.mostBytes = 20000; p.scene.request();")
        for step in range(6):
            run(page, f"p.scene.zoom(1.6); p.scene.move({0.2 * (-1) ** step}, 0.1);")
            settle(page)
            settle(page)
            shown = run(page, "return p.tileset.choice.shown.length;")
            assert shown >= 1
        run(page, "p.scene.look(180, 90);")
        for _ in range(8):
            settle(page)
        bytes_kept, shown = run(page, "return [p.tileset.bytes, p.tileset.choice.shown.length];")
    assert bytes_kept <= 20_000 < whole[0]
    assert 1 <= shown < whole[1]


@pytest.mark.slow
def test_thousands_of_tiles_without_a_coarser_one_keep_to_the_memory(tmp_path):
    """As of many makers: a root without content, and all others below it."""
    across, width = 50, 256.0 / 50
    places = [(column * width, row * width) for column in range(across) for row in range(across)]
    children = [
        make_tile((x, y), (x + width, y + width), 0.0, uri=f"tiles/{k}.glb")
        for k, (x, y) in enumerate(places)
    ]
    contents = {
        f"tiles/{k}.glb": make_square_glb((x, y), (x + width, y + width), cells=1)
        for k, (x, y) in enumerate(places)
    }
    root = make_tile((0, 0), (256, 256), BIG, children=children)
    write_tileset(tmp_path, root, contents)
    with open_served(tmp_path, write_page(tmp_path, exaggeration=1.0)) as page:
        run(page, "p.tileset.mostBytes = 100000; p.scene.look(180, 90);")
        for _ in range(3):
            settle(page)
        kept, shown = run(page, "return [p.tileset.bytes, p.tileset.choice.shown.length];")
        assert kept < 105_000
        assert 100 < shown < 400
        assert "not all of this view, which needs more than 0 MB" in page.inner_text("#tiles")
        assert len(page.asked) < 500
        run(page, "for (let k = 0; k < 20; k += 1) p.scene.zoom(1.15); p.scene.draw();")
        for _ in range(3):
            settle(page)
        assert "not all" not in page.inner_text("#tiles")
        wanted, shown = run(page, "return [p.tileset.choice.wanted.length, p.tileset.isFull];")
        assert (wanted, shown) == (0, False)
        assert run(page, "return p.tileset.bytes;") < 105_000


@pytest.mark.slow
@pytest.mark.parametrize("size", [(360, 640), (640, 360)])
def test_on_a_phone_nothing_is_cut(terrain, size):
    from .test_page_phone import BOXES, CUT, TARGETS

    viewport = {"width": size[0], "height": size[1]}
    with open_served(terrain[0], "page.html", viewport=viewport, has_touch=True) as page:
        settle(page)
        assert page.evaluate(CUT) == []
        assert [one for one in page.evaluate(TARGETS) if min(one[1:]) < 40 - 0.5] == []
        boxes = page.evaluate(BOXES)
        view = boxes["view"]
        assert view[3] - view[1] >= 119
        for left, top, right, bottom in filter(None, boxes.values()):
            assert left >= 0
            assert right <= size[0]
            assert bottom > top


# ------------------------------------------------------------------ trees of others


def square(**how):
    return make_square_glb((-50, -50), (50, 50), **how)


def single(folder, content, *, uri="a.glb", **more):
    root = make_tile((-50, -50), (50, 50), 0.0, uri=uri, **more)
    write_tileset(folder, root, {} if content is None else {uri: content})
    return write_page(folder)


BASE = np.array([-1000.0, 2000.0, 30.0])


def moved(kind):
    """A content whose places are those of the plain one, by another way."""
    quarter = [0, 0, np.sqrt(0.5), np.sqrt(0.5)]
    return {
        "translation": lambda: square(
            origin=(1000, 0, 0), node={"translation": [1000, 0, 0]}
        ),
        "scale": lambda: make_square_glb(
            (-25, -25), (25, 25), node={"scale": [2, 2, 2]}, height=0
        ),
        "matrix": lambda: square(
            origin=(0, 64, 0), node={"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -64, 1]}
        ),
        "rtc": lambda: square(
            origin=(0, 64, 3),
            more={"extensions": {"CESIUM_RTC": {"center": [0, 64, 3]}},
                  "extensionsRequired": ["CESIUM_RTC"]},
        ),
        "b3dm": lambda: b3dm(square(origin=(7, 64, 3)), [7, 64, 3]),
        "no indices": lambda: square(index=None),
        "bytes": lambda: square(index="u1"),
        "stride": lambda: square(stride=8),
        "long": lambda: square(index="u4"),
        "quarter turn": lambda: square(
            node={"rotation": [quarter[0], quarter[2], 0, quarter[3]]}
        ),
    }[kind]()  # fmt: skip


def b3dm(glb, center):
    import struct

    table = json.dumps({"BATCH_LENGTH": 0, "RTC_CENTER": center}).encode()
    table += b" " * (-(28 + len(table)) % 8)
    whole = 28 + len(table) + len(glb)
    return struct.pack("<4sIIIIII", b"b3dm", 1, whole, len(table), 0, 0, 0) + table + glb


@pytest.mark.slow
@pytest.mark.parametrize(
    "kind",
    ["translation", "scale", "matrix", "rtc", "b3dm", "no indices", "bytes", "stride", "long",
     "quarter turn"],
)  # fmt: skip
def test_contents_of_others_are_where_they_say(kind, tmp_path):
    with open_served(tmp_path, single(tmp_path, moved(kind))) as page:
        settle(page)
        low, high, triangles, origin = run(
            page,
            """const s = p.tileset.surface.parts[0][1].models[0].surface;
          return [s.low, s.high, s.triangleCount, p.payload.origin];""",
        )
        hit = run(page, "const f = p.tileset.surface.pick([3, 4, 99], [0, 0, -1], 1); return f.z;")
    assert triangles == 8
    assert (np.array(low) + origin)[:2].tolist() == pytest.approx([-50, -50], abs=1e-4)
    assert (np.array(high) + origin)[:2].tolist() == pytest.approx([50, 50], abs=1e-4)
    assert abs(hit) < 2.5


@pytest.mark.slow
def test_transforms_of_tiles_are_joined_in_doubles(tmp_path):
    """A million kilometres from the origin, and a millimetre is a millimetre."""
    far = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1e9, -2e9, 5e4, 1]
    back = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.25, 0.5, 0, 1]
    child = make_tile((-50, -50), (50, 50), 0.0, uri="a.glb", transform=back)
    root = make_tile((-51, -51), (51, 51), 9.0, transform=far, children=[child])
    write_tileset(tmp_path, root, {"a.glb": square()})
    with open_served(tmp_path, write_page(tmp_path)) as page:
        settle(page)
        low, origin = run(
            page, "return [p.tileset.surface.parts[0][1].models[0].surface.low, p.payload.origin];"
        )
    assert (np.array(low) + origin)[:2].tolist() == [1e9 - 49.75, -2e9 - 49.5]


@pytest.mark.slow
def test_a_tileset_in_a_tileset(tmp_path):
    """Paths are taken from the file that names them; what holds itself is refused."""
    leaf = make_tile((0, -50), (50, 50), 0.0, uri="../contents/b.glb")
    write_tileset(tmp_path, leaf, {}, name="inner/tileset.json")
    again = make_tile((-50, -50), (0, 50), 0.0, uri="tileset.json")
    write_tileset(tmp_path, again, {}, name="inner/again.json")
    root = make_tile(
        *((-50, -50), (50, 50), BIG),
        uri="a.glb",
        children=[
            make_tile((0, -50), (50, 50), 1.0, uri="inner/tileset.json?v=1"),
            make_tile((-50, -50), (0, 50), 1.0, uri="inner/again.json"),
        ],
    )
    contents = {"a.glb": square(), "contents/b.glb": make_square_glb((0, -50), (50, 50))}
    write_tileset(tmp_path, root, contents)
    with open_served(tmp_path, write_page(tmp_path)) as page:
        settle(page)
        assert "inner/tileset.json?v=1" in page.asked
        assert "contents/b.glb" in page.asked
        assert run(page, "return p.tileset.failures;") == []
        assert "contents/b.glb" in page.asked
    root["children"][1]["content"]["uri"] = "inner/self.json"
    write_tileset(tmp_path, root, {})
    endless = make_tile((-50, -50), (0, 50), 0.0, uri="self.json")
    write_tileset(tmp_path, endless, {}, name="inner/self.json")
    with open_served(tmp_path, write_page(tmp_path)) as page:
        settle(page)
        assert "in which it stands itself" in page.inner_text("#failures")
        assert run(page, "return p.tileset.choice.shown.map((t) => t.contents[0]);") == ["a.glb"]


@pytest.mark.slow
def test_tiles_that_are_added_stay(tmp_path):
    write_quadtree(tmp_path, levels=2, refine="ADD")
    with open_served(tmp_path, write_page(tmp_path)) as page:
        run(page, "p.scene.look(180, 90); p.scene.zoom(1.6);")
        settle(page)
        assert run(page, "return p.tileset.choice.shown.map((t) => t.depth);") == [0, 1, 1, 1, 1]


# ------------------------------------------------------------------ what is refused


@pytest.mark.slow
@pytest.mark.parametrize(
    "uri",
    [
        "http://example.com/a.glb", "//example.com/a.glb", "../a.glb", "b/../../a.glb",
        "/a.glb", "%2e%2e/a.glb", "..%2fa.glb", "..\\a.glb", "data:,x", "blob:x", "HTTPS:a.glb",
        "javascript:alert(1)",
    ],
)  # fmt: skip
def test_nothing_outside_the_folder_is_asked_for(tmp_path, uri):
    folder = tmp_path / "in"
    folder.mkdir()
    (tmp_path / "a.glb").write_bytes(square())
    root = make_tile((-50, -50), (50, 50), 0.0, uri=uri)
    write_tileset(folder, root, {})
    write_page(folder)
    with open_served(tmp_path, "in/index.html", ready=IGNORED) as page:
        page.wait_for_selector("#folder")
        words = page.inner_text("#wait")
        assert "lies outside the folder of the tileset: nothing else is asked for." in words
        assert page.asked == ["in/index.html", "in/tileset.json"]


def change(**more):
    return json.dumps({"asset": {"version": "1.1"}, "geometricError": 9, **more}).encode()


ROOT = make_tile((-50, -50), (50, 50), 0.0, uri="a.glb")
GLOBE = {"boundingVolume": {"region": [-3, -1, 3, 1, 0, 100]}, "geometricError": 0}
FATAL = {
    "404": (404, "tileset.json cannot be read: the server answers 404"),
    "no JSON": (b"<html>", "tileset.json is no tileset: it is not JSON."),
    "a list": (b"[]", "it has no 'asset' with a version, or no 'root'"),
    "version": (
        change(root=ROOT).replace(b"1.1", b"0.0"),
        "tileset.json is 3D Tiles '0.0': 1.0 and 1.1 are read.",
    ),
    "extension": (change(root=ROOT, extensionsRequired=["X_y"]), "needs the extension 'X_y'"),
    "implicit": (change(root=ROOT | {"implicitTiling": {}}), "has implicit tiling"),
    "implicit, 1.0": (
        change(root=ROOT | {"extensions": {"3DTILES_implicit_tiling": {}}}),
        "has implicit tiling, which is not read",
    ),
    "no error": (
        change(root={k: v for k, v in ROOT.items() if k != "geometricError"}),
        "tileset.json: root has no 'geometricError' of 0 or more.",
    ),
    "no box": (change(root=ROOT | {"boundingVolume": {}}), "no box, sphere or region around it"),
    "short box": (
        change(root=ROOT | {"boundingVolume": {"box": [1, 2]}}),
        "has a volume or a transform that is not 12 numbers",
    ),
    "a child": (change(root=ROOT | {"children": [7]}), "root.children[0] is no tile."),
    "no uri": (change(root=ROOT | {"content": {}}), "has a content without a 'uri'"),
    "the globe": (change(root=GLOBE), "reaches over more of the globe than one map shows"),
    "no content": (change(root=make_tile((0, 0), (1, 1), 0)), "has no triangles to show"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", FATAL)
def test_a_tileset_that_cannot_be_shown_is_one_sentence(name, tmp_path):
    write_quadtree(tmp_path, levels=1)
    answer, words = FATAL[name]
    where = {"tileset.json": answer}
    with open_served(tmp_path, write_page(tmp_path), answers=where, ready=IGNORED) as page:
        page.wait_for_selector("#folder")
        text = page.inner_text("#wait span")
        assert text.startswith("The tileset cannot be shown: ")
        assert words in text
        assert page.is_hidden("#side")


NAN = square().replace(np.float32([50.0]).tobytes(), np.float32([np.nan]).tobytes())
FAILING = {
    "404": (404, "1/0/0.glb cannot be read: the server answers 404"),
    "truncated": (square()[:300], "1/0/0.glb is damaged: it ends too early."),
    "text": (b"<html>" * 9, "1/0/0.glb is no GLB"),
    "nothing": (b"", "1/0/0.glb is no GLB"),
    "old": (square().replace(b"glTF\2", b"glTF\1"), "1/0/0.glb is glTF 1: 2 is read."),
    "draco": (
        square(more={"extensionsRequired": ["KHR_draco_mesh_compression"]}),
        "1/0/0.glb is compressed by Draco, which is not read",
    ),
    "meshopt": (
        square(more={"extensionsRequired": ["EXT_meshopt_compression"]}),
        "1/0/0.glb is compressed by meshopt, which is not read",
    ),
    "points": (
        b"pnts" + bytes(24),
        "1/0/0.glb is a cloud of points (pnts): contents in GLB and b3dm",
    ),
    "instances": (b"i3dm" + bytes(28), "1/0/0.glb is models put at several places (i3dm): "),
    "composite": (b"cmpt" + bytes(12), "1/0/0.glb is a composite of several contents (cmpt): "),
    "subtree": (b"subt" + bytes(20), "1/0/0.glb is a subtree of implicit tiling: "),
    "glTF in JSON": (
        b'{"asset": {"version": "2.0"}, "scenes": [], "buffers": [{"uri": "a.bin"}]}',
        "1/0/0.glb is glTF in JSON: contents in GLB and b3dm are shown.",
    ),
    "numbers": (NAN, "1/0/0.glb is damaged: it has coordinates that are no numbers."),
    "corners": (
        tilesets.make_glb([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 9]]),
        "1/0/0.glb is damaged: its triangles cannot be read.",
    ),
    "a loop": (
        square(node={"children": [0]}),
        "1/0/0.glb is damaged: its node 0 cannot be read.",
    ),
    "JSON": (
        tilesets.pack_glb({"asset": {}, "scenes": 3, "nodes": [], "extensionsRequired": 4}),
        "1/0/0.glb is damaged: its JSON does not hold what glTF asks for.",
    ),
    "elsewhere": (
        square(more={"buffers": [{"byteLength": 9, "uri": "http://example.com/x.bin"}]}),
        "1/0/0.glb keeps its numbers in another file, which is not read.",
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", FAILING)
def test_a_tile_that_cannot_be_read_is_told_and_leaves_no_hole(name, tmp_path):
    write_quadtree(tmp_path, levels=2)
    answer, words = FAILING[name]
    where = {"1/0/0.glb": answer}
    with open_served(tmp_path, write_page(tmp_path), answers=where) as page:
        run(page, "p.scene.look(180, 90); p.scene.zoom(1.6);")
        settle(page)
        assert words in page.inner_text("#failures")
        assert page.get_attribute("#failures", "role") == "alert"
        assert run(page, "return p.tileset.choice.shown.map((t) => t.depth);") == [0]


@pytest.mark.slow
def test_a_content_without_triangles_is_an_empty_place(tmp_path):
    write_quadtree(tmp_path, levels=2)
    empty = tilesets.make_glb(np.empty((0, 3)), np.empty((0, 3), int))
    with open_served(tmp_path, write_page(tmp_path), answers={"1/0/0.glb": empty}) as page:
        run(page, "p.scene.look(180, 90); p.scene.zoom(1.6);")
        settle(page)
        assert run(page, "return p.tileset.failures;") == []
        assert run(page, "return p.tileset.choice.shown.map((t) => t.depth);") == [1, 1, 1]
