"""UGRID meshes: round trips, QGIS, forms that other programs write, damaged files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from support.mesh_files import write_and_read
from support.qgis_meshes import open_all_in_qgis
from support.surfaces import hills

import tinsmith as ts

netcdf = pytest.importorskip("netCDF4")

SQUARE = np.array([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]], float)


def make(path, *, faces, dtype="i4", fill=None, start=None, transposed=False, z=None, **names):
    """Write a mesh of the square as another program might."""
    z = {"standard_name": "altitude"} if z is None else z
    with netcdf.Dataset(path, "w", format=names.pop("format", "NETCDF4")) as data:
        data.createDimension("n", 4)
        data.createDimension("f", len(faces))
        data.createDimension("c", len(faces[0]))
        mesh = data.createVariable("mesh", "i4")
        mesh.setncatts({"cf_role": "mesh_topology", "topology_dimension": 2,
                        "node_coordinates": "mx my", "face_node_connectivity": "mf",
                        "face_dimension": "f"})  # fmt: skip
        for name, column in zip(("mx", "my"), SQUARE.T[:2], strict=True):
            data.createVariable(name, "f8", ("n",))[:] = column
        level = data.createVariable("level", "f8", ("n",))
        level.setncatts({"mesh": "mesh", "location": "node", **z})
        level[:] = SQUARE[:, 2]
        shape = ("c", "f") if transposed else ("f", "c")
        table = data.createVariable("mf", dtype, shape, fill_value=fill)
        if start is not None:
            table.start_index = start
        table[:] = np.array(faces).T if transposed else faces
        for name, value in names.items():
            mesh.setncattr(name, value)
    return path


def test_a_tin_comes_back_with_its_lines(tmp_path):
    tin = hills()
    back = write_and_read(tin, tmp_path / "a.nc")
    assert np.array_equal(back.constrained, tin.constrained)
    assert sorted(back.lines.kinds) == sorted(tin.lines.kinds)
    assert (back.crs, back.elevation_unit) == (tin.crs, tin.elevation_unit)
    assert ts.check(back, level=2).problems == ()


def test_a_large_tin_with_lines_is_known_by_its_convention(tmp_path):
    """With lines, the topology is described behind the part of a file that is looked at."""
    survey = Path(__file__).parents[3] / "sample_data" / "site_survey.csv"
    tin = ts.triangulate(ts.read(survey, crs="EPSG:32616"), max_edge=39)
    path = ts.write(tin, tmp_path / "large.nc")
    assert b"mesh_topology" not in path.read_bytes()[:65536]
    assert np.array_equal(ts.read(path).points, tin.points)


@pytest.mark.slow
def test_qgis_opens_our_ugrid(tmp_path):
    """One QGIS opens them all: it takes half a second to start."""
    names = ("EPSG:32616", "EPSG:2274", "EPSG:25832+7837")
    tins = {crs: hills(crs=crs, unit=None) for crs in names}
    paths = [ts.write(tin, tmp_path / f"{k}.nc") for k, tin in enumerate(tins.values())]
    for (crs, tin), seen in zip(tins.items(), open_all_in_qgis(paths, tmp_path), strict=True):
        assert seen["valid"], crs
        assert (seen["vertices"], seen["faces"]) == (len(tin.points), len(tin.triangles)), crs
        assert "+" in crs or seen["crs"] == crs
        z = tin.points[:, 2]
        assert seen["groups"]["Bed Elevation"] == [z.min(), z.max()], crs


@pytest.mark.parametrize("crs", ["EPSG:25832+7837", "+proj=tmerc +lon_0=9 +x_0=1000 +ellps=GRS80"])
def test_a_crs_without_one_number_comes_back(tmp_path, crs):
    tin = hills(crs=crs, unit=None)
    assert ts.read(ts.write(tin, tmp_path / "a.nc")).crs == tin.crs


def test_xarray_finds_the_topology(tmp_path):
    xarray = pytest.importorskip("xarray")
    tin = hills()
    with xarray.open_dataset(ts.write(tin, tmp_path / "a.nc"), engine="netcdf4") as data:
        mesh = data["mesh2d"].attrs
        x, y = (data[name].to_numpy() for name in mesh["node_coordinates"].split())
        faces = data[mesh["face_node_connectivity"]].to_numpy()
        z = data["mesh2d_node_z"]
        assert z.attrs["standard_name"] == "altitude"
        assert z.attrs["units"] == "US_survey_foot"
        assert np.array_equal(np.column_stack([x, y, z.to_numpy()]), tin.points)
        assert np.array_equal(faces, tin.triangles)


@pytest.mark.parametrize(
    "form",
    [
        {"faces": [[0, 1, 2], [0, 2, 3]]},
        {"faces": [[1, 2, 3], [1, 3, 4]], "start": 1},
        {"faces": [[0, 1, 2, -1], [0, 2, 3, -1]], "fill": -1},
        {"faces": [[1, 2, 3, -999], [1, 3, 4, -999]], "start": 1, "fill": -999},
        {"faces": [[0, 1, 2], [0, 2, 3]], "transposed": True},
        {
            "faces": [[0.0, 1.0, 2.0, np.nan], [0.0, 2.0, 3.0, np.nan]],
            "dtype": "f8",
            "fill": np.nan,
        },
        {"faces": [[0, 1, 2], [0, 2, 3]], "format": "NETCDF3_CLASSIC"},
    ],
)
def test_forms_of_the_faces(tmp_path, form):
    tin = ts.read(make(tmp_path / "a.nc", **form))
    assert tin.area == 12
    assert float(tin.interpolate([4, 0])) == 6
    assert len(tin.triangles) == 2


def test_polygons_are_cut_and_told(tmp_path):
    tin = ts.read(make(tmp_path / "a.nc", faces=[[0, 1, 2, 3]]))
    assert tin.area == 12
    assert "1 polygon of the file was cut" in tin.report.notes[0]


def test_depths_change_their_sign_and_it_is_told(tmp_path):
    path = make(tmp_path / "a.nc", faces=[[0, 1, 2]], z={"positive": "down", "units": "ft"})
    tin = ts.read(path)
    assert tin.points[:3, 2].tolist() == [-5, -6, -7]
    assert tin.elevation_unit.name == "foot"
    assert "grow downwards" in tin.report.notes[0]


def test_elevations_that_are_not_told_are_asked_for(tmp_path):
    path = make(tmp_path / "a.nc", faces=[[0, 1, 2]], z={"long_name": "what"})
    with pytest.raises(ts.ReadError, match="name the variable that they are in"):
        ts.read(path)
    assert ts.read(path, variable="level").points[0, 2] == 5
    with pytest.raises(ts.ReadError, match="no variable 'depth'"):
        ts.read(path, variable="depth")


def test_several_meshes_are_chosen_by_name(tmp_path):
    path = make(tmp_path / "a.nc", faces=[[0, 1, 2]])
    with netcdf.Dataset(path, "a") as data:
        other = data.createVariable("other", "i4")
        other.setncatts({"cf_role": "mesh_topology", "face_node_connectivity": "mf"})
    with pytest.raises(ts.ReadError, match="2 meshes: name one as surface, 'mesh', 'other'"):
        ts.read(path)
    assert len(ts.read(path, surface="mesh").triangles) == 1


@pytest.mark.parametrize(
    ("form", "sentence"),
    [
        ({"faces": [[0, 1, 9]]}, "names vertex 9"),
        ({"faces": [[0, 1, -1]], "fill": -1}, "3 or more are needed"),
        ({"faces": [[0, 1, 2]], "node_coordinates": "mx nowhere"}, "no such variable"),
        ({"faces": [[0, 1, 2]], "node_coordinates": "mx"}, "names no node_coordinates"),
        ({"faces": [[0, 1, 2.5]], "dtype": "f8"}, "names the node 2.5"),
    ],
)
def test_damaged_files(tmp_path, form, sentence):
    with pytest.raises(ts.ReadError, match=sentence):
        ts.read(make(tmp_path / "a.nc", **form))


def test_nodes_without_elevation_are_refused(tmp_path):
    path = make(tmp_path / "a.nc", faces=[[0, 1, 2]])
    with netcdf.Dataset(path, "a") as data:
        data["level"][1] = np.nan
    with pytest.raises(ts.ReadError, match="1 node has no elevation"):
        ts.read(path)
