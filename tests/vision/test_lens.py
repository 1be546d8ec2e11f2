"""The camera model against OpenCV's projection and its inverse."""

from __future__ import annotations

import pickle
from math import cos, nan, pi, radians, sin
from typing import Any

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from hilbed.types import Array, ScenarioError
from hilbed.vision.lens import Lens

BARREL: dict[str, float] = {"k1": -0.28, "k2": 0.11, "p1": 1e-3, "p2": -2e-3, "k3": -0.02}
LENSES = {
    "pinhole": Lens.of_fov(640, 64, pi / 2),
    "barrel": Lens(640, 480, 420.0, 415.0, 322.0, 236.0, **BARREL),
    "pincushion": Lens(640, 480, 500.0, 500.0, 319.5, 239.5, k1=0.15, k2=0.03),
    "tilted": Lens(640, 480, 320.0, 320.0, 319.5, 239.5, tilt=0.4),
    "everything": Lens(640, 480, 420.0, 415.0, 322.0, 236.0, **BARREL, tilt=-0.3, roll=0.2),
}


def projected(lens: Lens, azimuth: Array, elevation: Array) -> Array:
    """Returns pixels (n, 2) of directions about the pan axis, by cv2 alone."""
    ct, st, cr, sr = cos(lens.tilt), sin(lens.tilt), cos(lens.roll), sin(lens.roll)
    pitch = np.array([[ct, 0.0, st], [0.0, 1.0, 0.0], [-st, 0.0, ct]])
    roll = np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
    optical = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])
    level = np.cos(elevation)
    rays = np.column_stack((level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)))
    turn, _ = cv2.Rodrigues(optical @ (pitch @ roll).T)
    pixels, _ = cv2.projectPoints(5.0 * rays, turn, np.zeros(3), lens.matrix, lens.distortion)
    return np.asarray(pixels, float).reshape(-1, 2)


def grid(lens: Lens) -> tuple[Array, Array]:
    columns, rows = np.meshgrid(np.linspace(0, lens.width - 1, 23), np.linspace(0, lens.height - 1, 17))
    return columns.ravel(), rows.ravel()


@pytest.mark.parametrize("name", LENSES)
def test_directions_are_those_that_opencv_projects_back_on_the_pixel(name: str) -> None:
    lens = LENSES[name]
    column, row = grid(lens)
    azimuth, elevation = lens.direction(column, row)
    assert_allclose(projected(lens, azimuth, elevation), np.column_stack((column, row)), atol=1e-8)
    assert_allclose(
        np.column_stack(lens.pixel(azimuth, elevation)), np.column_stack((column, row)), atol=1e-8
    )


@pytest.mark.parametrize("name", LENSES)
def test_numbers_give_what_arrays_give(name: str) -> None:
    lens = LENSES[name]
    azimuth, elevation = (float(x) for x in lens.direction(500.0, 20.0))
    assert_allclose(lens.direction(np.array([500.0]), np.array([20.0])), [[azimuth], [elevation]], atol=1e-15)
    assert_allclose([float(x) for x in lens.pixel(azimuth, elevation)], [500.0, 20.0], atol=1e-9)


@given(st.integers(16, 4096), st.integers(16, 4096), st.floats(0.01, 3.1), st.floats(-0.49, 0.49))
def test_column_and_azimuth_are_inverse(width: int, height: int, fov: float, fraction: float) -> None:
    lens = Lens.of_fov(width, height, fov)
    azimuth = fraction * fov
    assert lens.azimuth(lens.column(azimuth)) == pytest.approx(azimuth, abs=1e-9)
    assert float(lens.direction(lens.column(azimuth), lens.cy)[0]) == pytest.approx(azimuth, abs=1e-9)


def test_the_outer_edges_of_the_outer_pixels_span_the_field_of_view() -> None:
    lens = Lens.of_fov(640, 64, pi / 2)
    assert lens.azimuth(-0.5) == pytest.approx(pi / 4)
    assert lens.azimuth(639.5) == pytest.approx(-pi / 4)
    assert lens.azimuth(319.5) == 0.0
    assert lens.fov == pytest.approx(pi / 2)
    assert lens.span == pytest.approx((-pi / 4, pi / 4))


def test_on_the_horizon_a_tilted_camera_sees_the_azimuth_at_another_row() -> None:
    lens = LENSES["tilted"]
    column, row = lens.pixel(0.3, 0.0)
    assert lens.column(0.3) == float(column)
    assert float(row) < lens.cy  # it looks down, so the horizon is in the upper half
    low, high = lens.span
    assert low < -pi / 4
    assert high > pi / 4


def test_behind_the_camera_and_beyond_its_distortion_there_is_no_pixel() -> None:
    assert np.isnan(LENSES["pinhole"].pixel(pi, 0.0)).all()
    assert np.isnan(LENSES["barrel"].pixel(1.55, 0.0)).all()


def test_a_lens_can_be_sent_to_another_process() -> None:
    lens = LENSES["everything"]
    lens.direction(1.0, 2.0)
    assert pickle.loads(pickle.dumps(lens)) == lens


def pinhole(**changes: Any) -> Lens:
    return Lens(**({"width": 640, "height": 64, "fx": 320.0, "fy": 320.0, "cx": 319.5, "cy": 31.5} | changes))


@pytest.mark.parametrize(
    ("width", "height", "degrees", "word"),
    [
        (0, 64, 90, "width"),
        (640, 100_000, 90, "height"),
        (640, 64, 180, "field of view"),
        (640, 64, 200, "field of view"),
        (640, 64, 0, "field"),
        (640, 64, nan, "field"),
    ],
)
def test_a_view_that_cannot_be_is_refused(width: int, height: int, degrees: float, word: str) -> None:
    with pytest.raises(ScenarioError, match=word):
        Lens.of_fov(width, height, radians(degrees))


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"fx": 0.0}, "fx is 0"),
        ({"fy": -1.0}, "fy"),
        ({"k1": nan}, "k1 is nan"),
        ({"tilt": 1.5}, "tilt is 85.94°"),
        ({"k1": -0.5}, "folds the image between its middle and column"),
        ({"k2": -0.4}, "folds"),
        ({"p1": 5.0}, "folds"),
        ({"k1": 1e300}, "folds"),
        ({"k1": -0.03, "fx": 60.0}, "folds"),
        ({"fx": 25.0, "fy": 25.0, "k1": 1e-9}, "off the middle"),
    ],
)
def test_a_lens_that_cannot_be_is_refused(changes: dict[str, float], word: str) -> None:
    with pytest.raises(ScenarioError, match=word):
        pinhole(**changes)


def test_a_lens_is_refused_exactly_where_the_radius_in_the_image_stops_growing() -> None:
    """Brute force along the way to the corner, the farthest from the middle."""
    corner = np.hypot(320.0, 32.0) / 320.0
    radius = np.linspace(0.0, 3.0, 30_001)
    for k1 in (-0.10, -0.13, -0.14, -0.147, -0.149, -0.16, -0.3):
        image = radius * (1.0 + k1 * radius**2)
        top = int(np.argmax(np.diff(image) <= 0.0)) or len(image) - 1
        if image[top] > corner:
            pinhole(k1=k1)
        else:
            with pytest.raises(ScenarioError, match="folds"):
                pinhole(k1=k1)
