"""Labels of contours: where they stand, how they are turned, what they say."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts


def cone():
    turn = 2 * np.pi * np.arange(48) / 48
    parts = [[[0.0, 0.0, 10.0]]]
    for radius in (2.0, 4.0, 6.0, 8.0, 10.0):
        z = np.full(48, 10 - radius)
        parts.append(np.column_stack([radius * np.cos(turn), radius * np.sin(turn), z]))
    return ts.triangulate(np.concatenate(parts))


def test_labels_stand_on_their_line_upright_and_along_it():
    tin = cone()
    lines = ts.contours(tin, interval=1, index=3)
    labels = ts.contour_labels(lines, spacing=5)
    x, y, z = labels.coordinates.T
    assert np.hypot(x, y) == pytest.approx(10 - z, rel=0.01)
    turn = labels.columns["rotation"]
    assert ((turn > -90) & (turn <= 90)).all()
    along = np.column_stack([np.cos(np.radians(turn)), np.sin(np.radians(turn))])
    assert np.abs((along * labels.coordinates[:, :2]).sum(axis=1)).max() < 0.5
    assert set(labels.columns["elevation"]) <= {3.0, 6.0, 9.0}
    assert len(labels) > 8


def test_uphill_tells_the_side_of_the_text_on_which_the_ground_rises():
    tin = cone()
    labels = ts.contour_labels(ts.contours(tin, interval=1), spacing=5, index_only=False)
    turn = np.radians(labels.columns["rotation"])
    up = np.column_stack([-np.sin(turn), np.cos(turn)])
    rises = tin.interpolate(labels.coordinates[:, :2] + 0.1 * up) > labels.coordinates[:, 2]
    assert np.array_equal(np.where(rises, "above", "below"), labels.columns["uphill"])
    assert set(labels.columns["uphill"]) == {"above", "below"}


@pytest.mark.parametrize(
    ("slope", "rotation", "uphill"),
    [((1, 0), 90, "below"), ((-1, 0), 90, "above"), ((0, 1), 0, "above"), ((0, -1), 0, "below"),
     ((1, 1), -45, "above"), ((-1, 1), 45, "above"), ((1, -1), 45, "below")],
)  # fmt: skip
def test_rotation_on_planes(slope, rotation, uphill):
    corners = np.array([[-5.0, -5], [5, -5], [5, 5], [-5, 5]])
    tin = ts.triangulate(np.column_stack([corners, corners @ slope]))
    labels = ts.contour_labels(ts.contours(tin, levels=[0]), spacing=20)
    assert labels.columns["rotation"] == pytest.approx([rotation])
    assert labels.columns["uphill"].tolist() == [uphill]
    assert labels.coordinates[0, :2] == pytest.approx([0, 0], abs=1e-12)  # the middle of the line


@pytest.mark.parametrize(
    ("interval", "texts"), [(0.25, "4.25 4.50 4.75"), (1, "5 6 7"), (0.5, "4.5 5.0 5.5")]
)
def test_texts_have_the_decimals_of_the_levels(interval, texts):
    tin = ts.triangulate([[0, 0, 4.2], [9, 0, 7.2], [9, 9, 7.2], [0, 9, 4.2]])
    labels = ts.contour_labels(ts.contours(tin, interval=interval, index=1), spacing=5)
    assert " ".join(sorted(set(labels.columns["text"]))[:3]) == texts


@pytest.mark.parametrize(
    ("levels", "texts"),
    [
        ([4.5, 4.5005, 4.501], ["4.5000", "4.5005", "4.5010"]),
        ([0.1 + 0.2 + 4, 5.3], ["4.3", "5.3"]),
        ([4 + 1 / 3], ["4.33333"]),
        ([-0.0, 1.0], ["0", "1"]),
        ([5.0], ["5"]),
    ],
)
def test_texts_tell_levels_apart(levels, texts):
    tin = ts.triangulate([[0, 0, -4], [9, 0, 7.2], [9, 9, 7.2], [0, 9, -4]])
    labels = ts.contour_labels(ts.contours(tin, levels=levels), spacing=5, index_only=False)
    found = set(labels.columns["text"])
    assert found
    assert found <= set(texts)


def test_labels_are_apart_and_short_lines_have_none():
    tin = cone()
    lines = ts.contours(tin, interval=0.1)
    labels = ts.contour_labels(lines, spacing=8, index_only=False)
    xy = labels.coordinates[:, :2]
    gaps = np.linalg.norm(xy[:, None] - xy[None], axis=-1)
    assert gaps[np.triu_indices(len(xy), 1)].min() >= 0.12 * 8
    short = lines.columns["length"] < 0.2 * 8
    assert short.any()
    assert not set(labels.columns["line"]) & set(np.flatnonzero(short))


def test_no_lines_have_no_labels():
    labels = ts.contour_labels(ts.contours(cone(), interval=100))
    assert len(labels) == 0
    assert "there is no line" in labels.notes[-1]


@pytest.mark.parametrize("spacing", [0, -1, np.nan, "wide"])
def test_a_spacing_that_is_none_is_refused(spacing):
    with pytest.raises(ts.OptionError, match=r"Invalid spacing .*a length > 0 in CRS units"):
        ts.contour_labels(ts.contours(cone(), interval=1), spacing=spacing)


def test_what_are_no_contours_is_refused():
    with pytest.raises(ts.OptionError, match="contours, as tinsmith"):
        ts.contour_labels(ts.contour_bands(cone(), interval=1))
