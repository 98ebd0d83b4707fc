"""A drawing opens with all of its data in view."""

import numpy as np
import pytest

import tinsmith as ts

ezdxf = pytest.importorskip("ezdxf")
POINTS = np.array([[752_700, 4e6, 5], [752_800, 4e6, 6], [752_700, 4_000_050, 8]])
pytestmark = pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")


@pytest.mark.parametrize("version", ["R12", "R2010"])
@pytest.mark.parametrize("unit", ["m", "ft"])
@pytest.mark.parametrize("kind", ["tin", "contours", "points"])
def test_extents_and_active_view_are_those_of_the_data(tmp_path, version, unit, kind):
    tin = ts.triangulate(POINTS, crs="EPSG:32616", elevation_unit=unit)
    made = {
        "tin": tin,
        "contours": ts.contours(tin, interval=1),
        "points": ts.Survey(points=POINTS, crs="EPSG:32616", elevation_unit=unit),
    }[kind]
    ts.write(made, tmp_path / "a.dxf", version=version)
    drawing = ezdxf.readfile(tmp_path / "a.dxf")
    places = made.coordinates if kind == "contours" else POINTS
    expected = places * (1, 1, 0.3048 if unit == "ft" else 1)
    assert np.allclose(drawing.header["$EXTMIN"], expected.min(axis=0), atol=1e-6)
    assert np.allclose(drawing.header["$EXTMAX"], expected.max(axis=0), atol=1e-6)
    (view,) = drawing.viewports.get("*Active")
    low, high = expected[:, :2].min(axis=0), expected[:, :2].max(axis=0)
    assert np.allclose(tuple(view.dxf.center)[:2], (low + high) / 2, atol=1e-6)
    assert view.dxf.height >= (high - low)[1]
    assert view.dxf.height * 1.5 >= (high - low)[0]
    assert view.dxf.height < 2 * max(high - low)


@pytest.mark.parametrize(("unit", "mm"), [("m", 1000.0), ("ft", 304.8), ("US survey foot", 1.0)])
def test_the_paper_and_its_scale_are_in_the_unit_of_the_drawing(tmp_path, unit, mm):
    """Those of ezdxf are 420 by 297 units: LibreCAD would print on 420 m. US feet it has not."""
    tin = ts.triangulate(POINTS, elevation_unit=unit)
    ts.write(tin, tmp_path / "a.dxf", unit=unit)
    header = ezdxf.readfile(tmp_path / "a.dxf").header
    assert header["$PLIMMAX"] == pytest.approx((420.0 / mm, 297.0 / mm))
    scale = header["$PSVPSCALE"]
    assert scale * mm * 110.0 * 50.0 / 100.0 <= 297.0
    middle = (POINTS.min(axis=0) + POINTS.max(axis=0))[:2] / 2
    on_paper = middle * scale + np.array(header["$PINSBASE"][:2])
    assert on_paper == pytest.approx([210.0 / mm, 148.5 / mm], rel=1e-6)


def test_points_are_crosses_as_large_as_their_labels(tmp_path):
    survey = ts.Survey(points=POINTS, attributes={"number": np.arange(3)})
    ts.write(survey, tmp_path / "a.dxf")
    document = ezdxf.readfile(tmp_path / "a.dxf")
    text, *_ = document.modelspace().query("TEXT")
    assert (document.header["$PDMODE"], document.header["$PDSIZE"]) == (3, text.dxf.height)
    ts.write(ts.Survey(points=POINTS[:1]), tmp_path / "one.dxf")
    (view,) = ezdxf.readfile(tmp_path / "one.dxf").viewports.get("*Active")
    assert view.dxf.height == 10.0
