"""Hostile files: what fetches, names other files, hangs, crashes or asks for all memory."""

import struct
import threading
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, HTTPServer

import numpy as np
import pytest
from support.refusals import refuse

import tinsmith as ts
from tinsmith.io import ReadError, read, read_lines, read_rings
from tinsmith.io.isolated import limits
from tinsmith.io.raster import virtual as raster_virtual

rasterio = pytest.importorskip("rasterio")
pytest.importorskip("pyogrio")
from rasterio.transform import Affine  # noqa: E402

CRS = "EPSG:32616"
PLACE = "<SRS>EPSG:32616</SRS><GeoTransform>752660,5,0,4024310,0,-5</GeoTransform>"


@pytest.fixture
def server():
    """Yield the address of a server on this machine, and the list of what it was asked for."""
    asked = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self):
            asked.append(self.path)
            self.send_response(404)
            self.end_headers()

        do_HEAD = do_GET

        def log_message(self, *_):
            pass

    listening = HTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=listening.serve_forever, args=(0.01,), daemon=True)
    thread.start()
    yield f"http://127.0.0.1:{listening.server_port}", asked
    listening.shutdown()
    listening.server_close()
    thread.join()


@pytest.fixture
def hurry(monkeypatch):
    """Let hanging files be given up after a second of processor time."""
    monkeypatch.setattr(limits, "LEAST_SECONDS", 1.0)


def refused(reader, path, error=ts.TinsmithError, **options):
    return refuse("", reader, path, error=error, **options)


def virtual(source, *, relative=0, size=(30, 24), extra=""):
    band = (
        f'<SourceFilename relativeToVRT="{relative}">{source}</SourceFilename><SourceBand>1'
        f"</SourceBand>{extra}"
    )
    return (
        f'<VRTDataset rasterXSize="{size[0]}" rasterYSize="{size[1]}">{PLACE}<VRTRasterBand '
        f'dataType="Float32" band="1"><SimpleSource>{band}</SimpleSource></VRTRasterBand>'
        "</VRTDataset>"
    )


def geotiff(path, cells=None):
    cells = np.arange(24 * 30, dtype="float32").reshape(24, 30) if cells is None else cells
    size = {"width": cells.shape[1], "height": cells.shape[0], "count": 1, "dtype": cells.dtype}
    place = {"transform": Affine(5, 0, 752660, 0, -5, 4024310), "crs": CRS}
    with rasterio.open(path, "w", driver="GTiff", **size, **place) as dataset:
        dataset.write(cells, 1)
    return path


# ------------------------------------------------------------------ references in rasters


def references(address):
    """Return texts that GDAL takes for rasters elsewhere."""
    return {
        "vrt": virtual(f"/vsicurl/{address}/a.tif"),
        "vrt with a declaration": f'<?xml version="1.0"?>\n<!-- x -->\n{virtual("/etc/passwd")}',
        "warped": '<VRTDataset subClass="VRTWarpedDataset" rasterXSize="9" rasterYSize="9"/>',
        "wms": f'<GDAL_WMS><Service name="TMS"><ServerUrl>{address}/${{z}}/${{x}}/${{y}}'
        "</ServerUrl></Service><DataWindow><UpperLeftX>-20037508</UpperLeftX><UpperLeftY>20037508"
        "</UpperLeftY><LowerRightX>20037508</LowerRightX><LowerRightY>-20037508</LowerRightY>"
        "<TileLevel>2</TileLevel></DataWindow><Projection>EPSG:3857</Projection></GDAL_WMS>",
        "wcs": f"<WCS_GDAL><ServiceURL>{address}/wcs?</ServiceURL><CoverageName>a</CoverageName>"
        "</WCS_GDAL>",
        "wmts": f"<GDAL_WMTS><GetCapabilitiesUrl>{address}/c.xml</GetCapabilitiesUrl></GDAL_WMTS>",
        "catalog": '{"stac_version": "1.0.0", "type": "Feature", "assets": {"a": {"href": "'
        f'{address}/a.tif", "eo:bands": [], "proj:epsg": 32616}}}}}}',
        "service": f'{{"currentVersion": 10.1, "capabilities": "Map", "tileInfo": "{address}"}}',
        "pds": f"PDS_VERSION_ID = PDS3\n^IMAGE = \"{address}/a.img\"\nOBJECT = IMAGE\nEND\n",
        "tile index": f'<GDALTileIndexDataset><IndexDataset>{address}/a.gpkg</IndexDataset>'
        "</GDALTileIndexDataset>",
        "pansharpened": '<VRTDataset subClass="VRTPansharpenedDataset"/>',
    }  # fmt: skip


@pytest.mark.parametrize("kind", references(""))
@pytest.mark.parametrize("suffix", [".csv", ".tif", ".geojson", ".vrt"])
def test_texts_that_name_rasters_elsewhere_fetch_nothing(tmp_path, server, kind, suffix):
    address, asked = server
    path = tmp_path / f"a{suffix}"
    path.write_text(references(address)[kind])
    refused(read, path)
    refused(read, path, format="raster")
    assert asked == []


@pytest.mark.parametrize("beside", [".msk", ".ovr", ".aux.xml"])
def test_files_beside_a_raster_fetch_nothing(tmp_path, server, beside):
    address, asked = server
    path = geotiff(tmp_path / "a.tif")
    text = virtual(f"/vsicurl/{address}/a.tif")
    if beside == ".aux.xml":
        text = (
            '<PAMDataset><Metadata domain="OVERVIEWS"><MDI key="OVERVIEW_FILE">/vsicurl/'
            f"{address}/a.ovr</MDI></Metadata></PAMDataset>"
        )
    (tmp_path / f"a.tif{beside}").write_text(text)
    survey = read(path)
    assert survey.points[:, 2].tolist() == list(range(720))
    (tmp_path / "b.vrt").write_text(virtual("a.tif", relative=1))
    assert "beside it" in refused(read, tmp_path / "b.vrt", ReadError)
    assert asked == []


def test_a_mosaic_of_files_in_its_folder_is_read(tmp_path):
    (tmp_path / "tiles").mkdir()
    geotiff(tmp_path / "tiles" / "a.tif")
    path = tmp_path / "a.vrt"
    path.write_text(virtual("tiles/a.tif", relative=1))
    assert read(path).points[:, 2].tolist() == list(range(720))
    path.write_text(virtual(tmp_path / "tiles" / "a.tif"))
    assert len(read(path)) == 720
    with rasterio.open(tmp_path / "tiles" / "a.tif") as dataset:
        bounds = dataset.bounds
    first = read(path).points[0]
    assert (first[0], first[1]) == (bounds.left + 2.5, bounds.top - 2.5)


def test_a_mosaic_of_anything_else_is_refused(tmp_path, server):
    address, asked = server
    inside = tmp_path / "inside"
    inside.mkdir()
    geotiff(tmp_path / "outside.tif")
    geotiff(inside / "a.tif")
    (inside / "link.tif").symlink_to(tmp_path / "outside.tif")
    (inside / "b.tif").write_text(virtual("a.tif", relative=1))
    (inside / "c.vrt").write_text(virtual("a.tif", relative=1))
    path = inside / "a.vrt"
    cases = {
        f"/vsicurl/{address}/a.tif": "not in its folder",
        "/etc/passwd": "not in its folder",
        "../outside.tif": "not in its folder",
        "link.tif": "not in its folder",
        "missing.tif": "no such file",
        "b.tif": "text of references",
        "c.vrt": "text of references",
        "NETCDF:a.tif:b": "no such file",
        "": "no such file",
        "a\0b": "damaged",
        "/vsizip/a.tif": "not in its folder",
    }
    for source, words in cases.items():
        path.write_text(virtual(source, relative=1))
        assert words in refused(read, path, ReadError), source
    assert asked == []


def test_a_mosaic_with_other_elements_is_refused(tmp_path):
    geotiff(tmp_path / "a.tif")
    path = tmp_path / "a.vrt"
    sound = virtual("a.tif", relative=1)
    raw = sound.replace("<VRTRasterBand ", '<VRTRasterBand subClass="VRTRawRasterBand" ')
    warped = sound.replace("<VRTDataset ", '<VRTDataset subClass="VRTWarpedDataset" ')
    texts = {
        virtual("a.tif", relative=1, extra="<OpenOptions/>"): "'OpenOptions'",
        raw: "VRTRawRasterBand",
        warped: "VRTWarpedDataset",
        '<!DOCTYPE a [<!ENTITY b "c">]>' + virtual("&b;"): "entities",
        "<OGRVRTDataSource/>": "no virtual raster",
        "1 2 3\n4 5 6\n7 8 9\n": "no virtual raster",
        sound.replace("</SimpleSource>", ""): "damaged",
        sound.replace(PLACE, PLACE + '<Metadata><MDI key="OVERVIEW_FILE">a</MDI></Metadata>'): (
            "names a file of overviews"
        ),
        sound.replace(PLACE, PLACE + "<Warp/>"): "has the element 'Warp'",
    }
    for text, words in texts.items():
        path.write_text(text)
        assert words in refused(read, path, ReadError)


def test_a_mosaic_of_a_large_text_is_not_parsed(tmp_path, monkeypatch):
    geotiff(tmp_path / "a.tif")
    path = tmp_path / "a.vrt"
    path.write_text(virtual("a.tif", relative=1))
    monkeypatch.setattr(raster_virtual, "LARGEST_TEXT", path.stat().st_size)
    read(path)
    monkeypatch.setattr(raster_virtual, "LARGEST_TEXT", path.stat().st_size - 1)
    assert "is larger than" in refused(read, path, ReadError)


@pytest.mark.parametrize("size", [(100_000, 100_000), (2**31 - 1, 2**31 - 1), (1, 2**31 - 1)])
def test_a_raster_of_more_cells_than_memory_is_refused_at_once(tmp_path, size, monkeypatch):
    from tinsmith.io.raster import reading as raster

    monkeypatch.setattr(raster, "measure_free_memory", lambda: 1 << 30)
    path = tmp_path / "bomb.vrt"
    text = virtual("", size=size)
    start, end = text.index("<SimpleSource>"), text.index("</VRTRasterBand>")
    path.write_text(text[:start] + text[end:])
    text = refused(read, path, ReadError)
    assert f"{size[0] * size[1]:,} cells" in text
    assert "window" in text


def test_a_geotiff_of_ten_thousand_million_cells_is_refused(tmp_path):
    path = tmp_path / "sparse.tif"
    size = {"width": 100_000, "height": 100_000, "count": 1, "dtype": "float32"}
    place = {
        "transform": Affine(5, 0, 752660, 0, -5, 4024310),
        "crs": CRS,
        "SPARSE_OK": True,
        "tiled": True,
    }
    with rasterio.open(path, "w", driver="GTiff", **size, **place):
        pass
    assert "10,000,000,000 cells" in refused(read, path, ReadError)
    assert len(read(path, cells=(5, 7, 3, 2))) == 6


# ------------------------------------------------------------------ references in vector files


def vector_references(address):
    """Return texts that GDAL takes for vector files elsewhere."""
    return {
        "ogr vrt": f'<OGRVRTDataSource><OGRVRTLayer name="a"><SrcDataSource>/vsicurl/{address}'
        "/a.geojson</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>",
        "ogr vrt of a file": '<OGRVRTDataSource><OGRVRTLayer name="lines"><SrcDataSource>lines.csv'
        "</SrcDataSource><GeometryType>wkbLineString</GeometryType></OGRVRTLayer>"
        "</OGRVRTDataSource>",
        "wfs": f"<OGRWFSDataSource><URL>{address}/wfs</URL></OGRWFSDataSource>",
        "feature service": f'{{"type": "FeatureService", "url": "{address}/0"}}',
        "pipeline": f'{{"type": "gdal_streamed_alg", "command_line": "gdal vector pipeline ! read '
        f'/vsicurl/{address}/a.geojson"}}',
        "service description": f'{{"openapi": "3.0.0", "links": [{{"rel": "data", "href": '
        f'"{address}/collections"}}], "collections": []}}',
    }


@pytest.mark.parametrize("kind", vector_references(""))
@pytest.mark.parametrize("suffix", [".csv", ".geojson", ".gml", ".vrt"])
def test_texts_that_name_lines_elsewhere_fetch_nothing(tmp_path, server, kind, suffix):
    address, asked = server
    (tmp_path / "lines.csv").write_text('WKT,k\n"LINESTRING (0 0, 1 1)",1\n')
    path = tmp_path / f"a{suffix}"
    path.write_text(vector_references(address)[kind])
    refused(read_lines, path)
    refused(read, path)
    assert asked == []


def test_a_schema_and_a_crs_in_the_network_are_not_fetched(tmp_path, server):
    address, asked = server
    gml = (
        '<a:FeatureCollection xmlns:a="http://ogr.maptools.org/" xmlns:gml='
        f'"http://www.opengis.net/gml" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
        f'xsi:schemaLocation="http://ogr.maptools.org/ {address}/a.xsd"><gml:featureMember>'
        f'<a:l fid="1"><a:g><gml:LineString srsName="{address}/crs"><gml:coordinates>0,0 1,1'
        "</gml:coordinates></gml:LineString></a:g></a:l></gml:featureMember></a:FeatureCollection>"
    )
    (tmp_path / "a.gml").write_text(gml)
    json = (
        '{"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "'
        f'{address}/crs"}}}}, "features": [{{"type": "Feature", "properties": {{}}, "geometry": '
        '{"type": "LineString", "coordinates": [[0, 0], [1, 1]]}}]}'
    )
    (tmp_path / "a.geojson").write_text(json)
    for name in ("a.gml", "a.geojson"):
        try:
            lines = read_lines(tmp_path / name, crs=CRS)
        except ts.TinsmithError:
            continue
        assert len(lines) == 1
    assert asked == []


@pytest.mark.parametrize(
    "name",
    [
        "http://127.0.0.1:9/a.tif",
        "https://127.0.0.1:9/a.csv",
        "s3://bucket/a.tif",
        "/vsicurl/http://127.0.0.1:9/a.geojson",
        "/vsizip/a.zip/a.shp",
        "zip://a.zip!a.tif",
        "/vsizip//vsicurl/http://127.0.0.1:9/a.zip/a.tif",
    ],
)
def test_addresses_are_no_files(name):
    wanted = "There is no file" if "zip" in name else "download it first"  # of this machine
    assert wanted in refused(read, name, ReadError)
    assert wanted in refused(read_lines, name, ReadError)
    assert wanted in refused(read_rings, name, ReadError)


# ------------------------------------------------------------------ hangs and crashes


@pytest.mark.parametrize("content", [b"0\rSECTION\r", b"  0\nSECTION\n  2\nENTITIES\n  0\nLINE"])
def test_a_drawing_that_never_ends_is_given_up(tmp_path, hurry, content):
    path = tmp_path / "a.dxf"
    path.write_bytes(content)
    assert "a.dxf" in refused(read_lines, path, ReadError)
    assert "a.dxf" in refused(read, path, ReadError)


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".vtu", ".vtp"])
def test_vtk_files_with_two_flipped_bits_leave_the_program_alive(tmp_path, suffix):
    pytest.importorskip("pyvista")
    rng = np.random.default_rng(3)
    tin = ts.triangulate(rng.random((62, 3)) * 30)
    path = tmp_path / f"a{suffix}"
    content = ts.write(tin, path).read_bytes()
    pairs = {
        (b"header_type", b"leader_type"),
        (b'header_type="UInt64"', b'header_type="UInt32"'),
        (b'format="appended"', b'format="eppended"'),
        (b'offset="0"', b'offset="2668"'),
        (b'NumberOfTuples="1"', b'NumberOfTuples="9"'),
        (b"Float64", b"Float32"),
        (b"UInt8", b"UInt9"),
        (b"Int64", b"Int16"),
        (b"vtkZLib", b"vtkLZ4D"),
        (b"LittleEndian", b"BigEndian"),
    }
    first = (b'format="appended"', b'format="eppended"')
    for second in sorted(pairs):
        path.write_bytes(content.replace(*first, 1).replace(*second, 1))
        with suppress(ReadError):
            assert np.isfinite(read(path).points).all()
    path.write_bytes(content.replace(*first, 1).replace(b"header_type", b"leader_type", 1))
    assert "a.vt" in refused(read, path, ReadError)
    path.write_bytes(content)
    assert np.array_equal(read(path).points, tin.points)


def test_counts_of_thousands_of_digits(tmp_path):
    digits = "1" * 5000
    files = {
        "a.ply": f"ply\nformat ascii 1.0\nelement vertex {digits}\nproperty double x\nend_header\n",
        "b.ply": "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
        f"property double z\nend_header\n0 0 {digits}\n",
        "a.vtu": f'<VTKFile type="UnstructuredGrid"><Piece NumberOfPoints="{digits}"></VTKFile>',
        "a.obj": f"v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 {'1' * 400}//1\n",
        "b.obj": f"v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 {digits}\n",
        "c.obj": f"v 0 0 {digits}\nv 1 0 1\nv 0 1 1\nf 1 2 3\n",
        "d.obj": "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 18446744073709551619\n",
        "a.msh": f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{digits}\n$EndNodes\n",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text)
        assert len(refused(read, tmp_path / name, ReadError)) < 600, name


@pytest.mark.parametrize("size", [28, 100], ids=["to the length", "a whole header"])
def test_a_shapefile_that_promises_more_than_it_has(tmp_path, size):
    head = struct.pack(">i20xi", 9994, 1 << 30) + struct.pack("<ii", 1000, 3) + bytes(64)
    for part in ("a.shp", "a.shx"):
        (tmp_path / part).write_bytes(head[:size])
    assert "cut short" in refused(read_lines, tmp_path / "a.shp", ReadError)
