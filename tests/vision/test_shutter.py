"""Which images a row collects, against the integral over its exposure."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from hilbed.vision.shutter import MOST, Shutter, collect, count, moments, shares

times = st.floats(0.0, 0.1)


@given(times, times, st.integers(1, MOST), st.integers(16, 200))
def test_every_row_is_made_of_whole_light(exposure: float, readout: float, images: int, rows: int) -> None:
    part = shares(Shutter(exposure, readout), images, rows)
    assert part.shape == (images, rows)
    assert (part >= 0.0).all()
    assert_allclose(part.sum(0), 1.0)


@pytest.mark.parametrize("shutter", [Shutter(0.01, 0.0), Shutter(0.0, 0.01), Shutter(0.004, 0.012)])
def test_the_mean_time_of_a_row_is_the_middle_of_its_exposure(shutter: Shutter) -> None:
    rows, images = 64, MOST
    mean = moments(shutter, images) @ shares(shutter, images, rows)
    late = shutter.readout * ((np.arange(rows) + 0.5) / rows - 0.5)
    assert_allclose(mean, late, atol=0.51 * shutter.span / images)
    assert mean.mean() == pytest.approx(0.0, abs=1e-6)


def test_without_readout_all_rows_collect_alike() -> None:
    assert_allclose(shares(Shutter(0.01, 0.0), 4, 20), 0.25)


@pytest.mark.parametrize("motion", [0.0, 0.2, 0.3, 1.0, 1.6, 5.0, 20.0])
def test_images_of_an_exposure_are_less_than_a_pixel_apart(motion: float) -> None:
    assert motion / count(motion) < 1.0
    assert (count(motion) == 1) == (motion < 0.25)
    assert count(1e6) == MOST


def test_light_is_the_mean_of_the_images_row_by_row() -> None:
    images = [np.full((4, 16, 3), level, np.uint8) for level in (0, 100)]
    part = np.array([[1.0, 0.5, 0.25, 0.0], [0.0, 0.5, 0.75, 1.0]])
    light = collect(images, part, slice(1, 4))
    assert_allclose(light[:, 0, 0], [50.0, 75.0, 100.0])
