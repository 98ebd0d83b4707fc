"""The cut and fill map: what it says, and where it is coloured how."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts

pytest.importorskip("matplotlib")

FLAT = ts.triangulate(
    [[0, 0, 1], [40, 0, 1], [40, 40, 1], [0, 40, 1]], crs="EPSG:32616", elevation_unit="m"
)
RAMP = ts.triangulate(
    [[0, 0, 0], [40, 0, 4], [40, 40, 4], [0, 40, 0]], crs="EPSG:32616", elevation_unit="m"
)


def test_axes_and_caption_have_units_and_volumes():
    axes = ts.earthwork_map(ts.difference(FLAT, RAMP), title="Pad").axes
    assert axes[0].get_xlabel() == "easting, m\nWGS 84 / UTM zone 16N (EPSG:32616)"
    assert axes[0].get_ylabel() == "northing, m"
    said = axes[0].get_title(loc="left")
    assert said == "Cut 200.0 m³ over 400.0 m²; fill 1,800 m³ over 1,200 m²; net 1,600 m³"
    assert axes[1].get_ylabel() == "cut (below 0) and fill (above 0), m"


def test_cut_is_red_and_fill_blue():
    figure = ts.earthwork_map(ts.difference(FLAT, RAMP), ground=FLAT)
    image = figure.axes[0].images[-1]
    colors = image.to_rgba(np.array([-3.0, 0.0, 3.0]), bytes=True).astype(int)
    (cut_red, _, cut_blue, _), (*zero, _), (fill_red, _, fill_blue, _) = colors
    assert cut_red > cut_blue + 50
    assert fill_blue > fill_red + 30
    assert min(zero) > 240
    values = image.get_array()
    assert (
        values[:, : values.shape[1] // 4 - 1].max()
        < 0
        < values[:, values.shape[1] // 4 + 1 :].min()
    )


def test_surfaces_that_agree_can_be_drawn():
    figure = ts.earthwork_map(ts.difference(FLAT, FLAT))
    assert figure.axes[0].get_title(loc="left").startswith("Cut 0.000 m³")


def test_unknown_units_are_left_out():
    bare = [tin.replace(crs=None, elevation_unit=None) for tin in (FLAT, RAMP)]
    axes = ts.earthwork_map(ts.difference(*bare)).axes
    assert axes[0].get_ylabel() == "northing"
    assert "Cut 200.0 over 400.0;" in axes[0].get_title(loc="left")
