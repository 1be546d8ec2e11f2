"""Optics and chip against their closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from hilbed.types import Image
from hilbed.vision.chip import Chip, blocks, develop, falloff, levels, normal, quantiles

SIZE = (64, 640)


def image_of(level: float, chip: Chip, seed: int = 1) -> Image:
    rng = np.random.default_rng(seed)
    image = np.empty((*SIZE, 3), np.uint8)
    for rows in blocks(*SIZE):
        light = np.full((rows.stop - rows.start, SIZE[1], 3), level, np.float32)
        develop(light, rows.start, chip, rng, image)
    return image


@pytest.mark.parametrize("level", [0, 1, 100, 254, 255])
def test_a_perfect_chip_changes_nothing(level: int) -> None:
    assert (image_of(level, Chip()) == level).all()


@pytest.mark.parametrize(("read", "shot", "level"), [(0.02, 0.0, 128), (0.0, 0.05, 64), (0.03, 0.04, 128)])
def test_noise_has_the_stated_deviation_and_no_bias(read: float, shot: float, level: int) -> None:
    error = image_of(level, Chip(read_noise=read, shot_noise=shot)).astype(float) - level
    std = 255.0 * np.hypot(read, shot * np.sqrt(level / 255.0))
    assert error.std() == pytest.approx(np.hypot(std, 1 / np.sqrt(12)), rel=0.02)  # and what rounding adds
    assert abs(error.mean()) < 0.08
    assert abs(np.corrcoef(error[:, :-1].ravel(), error[:, 1:].ravel())[0, 1]) < 0.01
    assert abs(np.corrcoef(error[..., 0].ravel(), error[..., 1].ravel())[0, 1]) < 0.02


def test_the_normal_numbers_are_normal() -> None:
    values = normal(200_000, np.random.default_rng(3)).astype(float)
    assert abs(values.mean()) < 0.01
    assert values.std() == pytest.approx(1.0, abs=0.01)
    assert np.mean(values**4) == pytest.approx(3.0, abs=0.08)
    assert np.mean(np.abs(values) < 1.0) == pytest.approx(0.6827, abs=0.004)
    assert_allclose(quantiles()[:10], -quantiles()[:-11:-1])


def test_gain_takes_light_and_noise_alike_and_full_scale_is_a_limit() -> None:
    assert (image_of(100, Chip(gain=2.0)) == 200).all()
    assert (image_of(200, Chip(gain=2.0)) == 255).all()
    noisy = image_of(60, Chip(gain=3.0, read_noise=0.01)).astype(float)
    assert noisy.std() == pytest.approx(3 * 2.55, rel=0.03)


def test_gamma_and_bits_are_their_formulas() -> None:
    assert (image_of(64, Chip(gamma=2.2)) == round(255 * (64 / 255) ** (1 / 2.2))).all()
    assert set(np.unique(levels(1.0, 1.0, 2)).tolist()) == {0, 85, 170, 255}
    assert set(np.unique(levels(1.0, 1.0, 1)).tolist()) == {0, 255}


def test_corners_lose_the_stated_part_of_the_light_and_the_middle_none() -> None:
    left = falloff(641, 65, 0.4)[..., 0]
    assert left[32, 320] == 1.0
    assert_allclose(left[[0, 0, -1, -1], [0, -1, 0, -1]], 0.6, rtol=1e-6)
    assert image_of(200, Chip(vignetting=0.4))[0, 0, 0] == 120


def test_noise_is_that_of_the_seed() -> None:
    chip = Chip(read_noise=0.1)
    assert_array_equal(image_of(99, chip), image_of(99, chip))
    assert (image_of(99, chip) != image_of(99, chip, 2)).any()
