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
