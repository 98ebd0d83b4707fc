"""What programs that nobody here wrote find in files, and which program opens which format."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import tinsmith as ts

from .plain_readers import measure_landxml_alignment, parse_12da, parse_adcirc, parse_landxml
from .qgis_meshes import open_all_in_qgis, run_in_qgis


class Opener(NamedTuple):
    """A program, a function that requires that it finds in a file what was written, and a reason.

    ``open`` takes the path and what was written. ``reason`` says why no program opens it, if so.
    """

    program: str
    open: object
    reason: str = ""


def require(*names):
    """Skip the test where a command is missing; in CI this fails."""
    for name in names:
        if shutil.which(name) is None:
            pytest.skip(f"needs {name}")


def run_program(*words, folder=None, **surroundings):
    """Run a command and return what it printed."""
    done = subprocess.run(
        list(map(str, words)),
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
        cwd=folder,
        env={**os.environ, **surroundings},
    )
    assert done.returncode == 0, (words, done.stdout, done.stderr)
    return done.stdout


def count(made):
    """Return how many records of a product a file has: features, rows, points."""
    if isinstance(made, ts.TIN):
        return len(made.points)
    return len(made.points) if isinstance(made, ts.Survey) else len(made)


# ---------------------------------------------------------------- tables, features, rasters


def open_in_pandas(path, made):
    """Require the rows of a table by pandas, and by the CSV driver of GDAL."""
    import pandas as pd

    if path.suffix == ".json":
        assert len(json.loads(path.read_text())["rows"]) == len(made)
        return
    found = pd.read_csv(path, sep="\t" if path.suffix == ".tsv" else ",")
    assert len(found) == count(made), path
    if path.suffix == ".csv":
        import pyogrio

        assert pyogrio.read_info(path)["features"] == count(made), path


def open_in_gdal(path, made):
    """Require the features of a vector file by GDAL, and their place."""
    import pyogrio

    (_, geometry), *_ = pyogrio.list_layers(path)
    found = pyogrio.read_info(path, force_total_bounds=True, force_feature_count=True)
    wanted = len(made.triangles) if isinstance(made, ts.TIN) else count(made)
    assert found["features"] == wanted, path
    assert geometry, path
    if not isinstance(made, ts.Features) and "json" not in path.suffix:
        low, high = made.points[:, :2].min(axis=0), made.points[:, :2].max(axis=0)
        np.testing.assert_allclose(found["total_bounds"], [*low, *high], atol=1e-6)


def open_tin_in_gdal(path, made):
    """Require the layers of the GeoPackage of a TIN by GDAL."""
    import pyogrio

    for name, wanted in (("vertices", made.points), ("triangles", made.triangles)):
        assert pyogrio.read_info(path, layer=name)["features"] == len(wanted), path


def open_in_geopandas(path, made):
    """Require the features of GeoParquet by GeoPandas."""
    import geopandas

    wanted = len(made.triangles) if isinstance(made, ts.TIN) else count(made)
    assert len(geopandas.read_parquet(path)) == wanted, path


def open_in_rasterio(path, made):
    """Require the cells of a raster by GDAL."""
    import rasterio

    with rasterio.open(path) as found:
        assert found.shape == made.grid.shape, path
        first = next(iter(made.bands.values()))
        cells = found.read(1, masked=True).astype(float).filled(np.nan)
        np.testing.assert_allclose(cells, first, rtol=1e-5, atol=1e-4)


def open_in_pmtiles(path, made):
    """Require tiles by the reader of PMTiles's makers."""
    from pmtiles.reader import MmapSource, Reader, all_tiles

    with path.open("rb") as stream:
        source = MmapSource(stream)
        assert Reader(source).header()["addressed_tiles_count"] > 0
        assert sum(1 for _ in all_tiles(source)) > 0


# ------------------------------------------------------------------- points and meshes


def open_in_laspy(path, made):
    """Require the points by laspy."""
    import laspy

    found = laspy.read(path)
    assert len(found.points) == count(made)
    np.testing.assert_allclose(np.sort(found.z), np.sort(made.points[:, 2]), atol=1e-3)


def open_in_trimesh(path, made):
    """Require triangles and their extent by trimesh."""
    import trimesh

    found = trimesh.load(path, process=False, force="mesh")
    assert len(found.faces) == len(made.triangles), path
    wanted = np.ptp(made.points, axis=0)
    if path.suffix == ".glb":
        wanted = wanted[[0, 2, 1]]  # y is up
    np.testing.assert_allclose(found.extents, wanted, rtol=1e-4, atol=0.5)


def open_in_vtk(path, made):
    """Require points and cells by VTK."""
    import pyvista

    found = pyvista.read(path)
    assert (found.n_points, found.n_cells) == (len(made.points), len(made.triangles))


def open_in_meshio(path, made):
    """Require points and triangles by meshio."""
    import meshio

    found = meshio.read(path)
    assert len(found.points) == len(made.points)
    assert len(found.cells_dict["triangle"]) == len(made.triangles)


def open_in_cjio(path, made):
    """Require that cjio takes it for CityJSON with a TINRelief."""
    said = run_program(Path(sys.executable).with_name("cjio"), path, "info")
    assert "TINRelief" in said


def open_in_ifcopenshell(path, made):
    """Require the surface by IfcOpenShell."""
    import ifcopenshell

    (found,) = ifcopenshell.open(str(path)).by_type("IfcTriangulatedIrregularNetwork")
    assert len(found.Coordinates.CoordList) == len(made.points)
    assert len(found.CoordIndex) == len(made.triangles)


def open_in_mdal(path, made):
    """Require vertices and faces by MDAL in QGIS."""
    open_all_in_mdal([(path, made)])


def open_all_in_mdal(files):
    """Require vertices, faces and elevations of meshes by MDAL in QGIS, in one process."""
    seen = open_all_in_qgis([path for path, _ in files], files[0][0].parent)
    for (path, made), found in zip(files, seen, strict=True):
        assert found["valid"], path
        wanted = (len(made.points), len(made.triangles))
        assert (found["vertices"], found["faces"]) == wanted, path
        z = made.points[:, 2]
        ranges = list(found["groups"].values())
        assert any(np.allclose(one, [z.min(), z.max()]) for one in ranges), (path, found)


# -------------------------------------------------------- drawings and documents


def open_in_cad(path, made):
    """Require a drawing without faults by ezdxf, and a print that is not blank by LibreCAD."""
    import ezdxf

    document = ezdxf.readfile(path)
    assert not document.audit().errors, path
    kinds = {one.dxftype() for one in document.modelspace()}
    if isinstance(made, ts.TIN):
        assert len(document.modelspace().query("3DFACE")) == len(made.triangles)
    assert kinds, path
    page = print_in_librecad(path)
    assert measure_ink(page) > 0, f"{path} is blank in LibreCAD"


def print_in_librecad(path, *flags):
    """Return the PDF that LibreCAD prints of a drawing, true to its scale if no flag is given."""
    require("librecad")
    folder = path.parent / "librecad"
    folder.mkdir(exist_ok=True)
    surroundings = {"QT_QPA_PLATFORM": "offscreen", "HOME": str(folder)}
    run_program("librecad", "dxf2pdf", *flags, "-t", folder, path, **surroundings)
    page = folder / f"{path.stem}.pdf"
    assert page.is_file(), path
    return page


def measure_ink(path, page=1, dpi=40):
    """Return which share of the pixels of a page of a PDF, drawn by poppler, is not white."""
    from PIL import Image

    require("pdftoppm")
    name = path.with_name(f"{path.stem}-page")
    run_program("pdftoppm", "-r", dpi, "-f", page, "-l", page, "-singlefile", "-png", path, name)
    with Image.open(f"{name}.png") as picture:
        return float((np.asarray(picture.convert("L")) < 250).mean())


def open_in_poppler(path, made):
    """Require pages with texts, none of them blank, by poppler."""
    require("pdfinfo", "pdftotext")
    told = dict(
        line.split(":", 1) for line in run_program("pdfinfo", path).splitlines() if ":" in line
    )
    pages = int(told["Pages"])
    assert pages == (len(made) if hasattr(made, "__len__") else pages)
    assert run_program("pdftotext", path, "-").strip()
    for page in range(1, pages + 1):
        assert measure_ink(path, page) > 0, (path, page)


_DRAW = """
import json, sys
from PyQt5.QtGui import QColor, QImage, QPainter
from PyQt5.QtSvg import QSvgRenderer
from qgis.core import QgsApplication
app = QgsApplication([], False)
told = []
for path in sys.argv[1:]:
    drawn = QSvgRenderer(path)
    picture = QImage(400, 400, QImage.Format_RGB32)
    picture.fill(QColor("white"))
    painter = QPainter(picture)
    drawn.render(painter)
    painter.end()
    ink = sum(QColor(picture.pixel(x, y)).lightness() < 250 for x in range(400) for y in range(400))
    told.append([drawn.isValid(), ink])
print("ANSWER" + json.dumps(told), flush=True)
"""


def open_in_qt(path, made):
    """Require a drawing that is not blank by the SVG renderer of Qt."""
    ((is_valid, ink),) = run_in_qgis(_DRAW, [str(path)], path.parent)
    assert is_valid, path
    assert ink > 0, path


def open_in_pillow(path, made):
    """Require a picture that is not blank by Pillow."""
    from PIL import Image

    with Image.open(path) as picture:
        assert np.ptp(np.asarray(picture.convert("L"))) > 0, path


# ------------------------------------------- formats that no kept program reads here


def read_as_12da(path, made):
    """Require points and triangles of an archive of 12d Model."""
    if isinstance(made, ts.TIN):
        points, triangles, _ = parse_12da(path.read_text())
        assert np.array_equal(points, made.points)
        assert np.array_equal(triangles[:, [0, 2, 1]], made.triangles)
    else:
        text = path.read_text()
        assert all(repr(z) in text for z in made.points[:, 2].tolist()[:20])


def read_as_adcirc(path, made):
    """Require nodes, elements and boundaries of a mesh of ADCIRC or SCHISM."""
    nodes, elements, _ = parse_adcirc(path.read_text())
    assert np.array_equal(nodes[:, 1:], made.points * [1, 1, -1])
    assert np.array_equal(elements[:, 2:] - 1, made.triangles)


def read_as_landxml(path, made):
    """Require faces, points or elements of a LandXML."""
    if isinstance(made, ts.Alignment):
        measured, stated = measure_landxml_alignment(path)
        assert measured == pytest.approx(made.length, rel=1e-9)
        assert stated == pytest.approx(made.length, rel=1e-9)
        return
    points, faces, texts = parse_landxml(path)
    if isinstance(made, ts.TIN):
        assert len(faces) == len(made.triangles)
        corners = points[faces][:, :, [1, 0, 2]].reshape(-1, 9)
        wanted = made.points[made.triangles]
        turns = [np.roll(wanted, k, axis=1).reshape(-1, 9) for k in range(3)]
        turns += [np.roll(wanted[:, ::-1], k, axis=1).reshape(-1, 9) for k in range(3)]
        assert any(np.array_equal(corners, one) for one in turns)
    else:
        assert texts


_NONE = {
    "landxml": "GDAL, QGIS and IfcOpenShell have no driver, and the one reader on PyPI, survte, "
    "cannot be imported as it is packed.",
    "12da": "Only 12d Model reads it.",
    "adcirc": "MDAL has no driver, and adcircpy and pyschism were given up in 2023.",
}


def _plain(name, opener):
    return Opener("a reader of the tests, written from the specification", opener, _NONE[name])


_GDAL = Opener("GDAL", open_in_gdal)
_PANDAS = Opener("pandas and the CSV driver of GDAL", open_in_pandas)
_MDAL = Opener("MDAL in QGIS", open_in_mdal)
_TRIMESH = Opener("trimesh", open_in_trimesh)

FORMATS = {
    "delimited": _PANDAS,
    "csv": _PANDAS,
    "json": Opener("the JSON of Python", open_in_pandas),
    "geotiff": Opener("GDAL", open_in_rasterio),
    "cog": Opener("GDAL", open_in_rasterio),
    "asc": Opener("GDAL", open_in_rasterio),
    "terrain-tiles": Opener("pmtiles", open_in_pmtiles),
    "tin": Opener("GDAL", open_tin_in_gdal),
    "ply": _MDAL,
    "obj": _TRIMESH,
    "stl": _TRIMESH,
    "vtk": Opener("VTK", open_in_vtk),
    "gmsh": Opener("meshio", open_in_meshio),
    "2dm": _MDAL,
    "adcirc": _plain("adcirc", read_as_adcirc),
    "selafin": _MDAL,
    "ugrid": _MDAL,
    "cityjson": Opener("cjio", open_in_cjio),
    "glb": _TRIMESH,
    "off": _TRIMESH,
    "geojson": _GDAL,
    "geojsonseq": _GDAL,
    "gpkg": _GDAL,
    "flatgeobuf": _GDAL,
    "shapefile": _GDAL,
    "geoparquet": Opener("GeoPandas", open_in_geopandas),
    "landxml": _plain("landxml", read_as_landxml),
    "12da": _plain("12da", read_as_12da),
    "ifc": Opener("IfcOpenShell", open_in_ifcopenshell),
    "dxf": Opener("ezdxf and LibreCAD", open_in_cad),
    "las": Opener("laspy", open_in_laspy),
}
"""Of every format that is written the program that opens it."""

DOCUMENTS = {
    ".pdf": Opener("poppler", open_in_poppler),
    ".svg": Opener("the SVG renderer of Qt", open_in_qt),
    ".png": Opener("Pillow", open_in_pillow),
    ".dxf": FORMATS["dxf"],
}
"""The same of sheets of paper and pictures, by suffixes."""

ELSEWHERE = {
    "quantized-mesh": "tests/io/mesh/test_quantized_mesh.py",
    "preview": "tests/terrain/viewer/test_page.py",
}
"""What other tests open: tiles by a reader of their specification, pages by Chromium."""
