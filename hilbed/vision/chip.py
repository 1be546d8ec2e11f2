"""From light to grey levels: what the camera's optics and chip do to an image after it has been exposed."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hilbed.types import Array, Image, Rng

Light = npt.NDArray[np.float32]
"""(H, W, 3), linear: 255 is what a white surface sends at a gain of 1."""

_STEPS = 16  # of the converter for a level of 8 bits: 12 bits
_FULL = 256 * _STEPS
_DRAWS = 1 << 12  # a table of them stays in the cache
_BLOCK = 1 << 14  # pixels


class Chip(NamedTuple):
    """What is wrong with a camera, in the order in which it happens.

    vignetting: part of the light that the corners lose, growing with the square of the distance from the
    middle; shot_noise, read_noise: standard deviations at full light and at none, as parts of full scale;
    gain: of light and noise alike; gamma: levels are light to the power of 1/gamma; bits: of a level.
    """

    vignetting: float = 0.0
    shot_noise: float = 0.0
    read_noise: float = 0.0
    gain: float = 1.0
    gamma: float = 1.0
    bits: int = 8

    @property
    def noisy(self) -> bool:
        return bool(self.shot_noise or self.read_noise)


PERFECT = Chip()
_LINEAR = PERFECT[-3:]  # gain, gamma, bits: levels are light


def blocks(height: int, width: int) -> Iterator[slice]:
    """Yields the rows of an image in blocks small enough for the processor's cache."""
    rows = max(1, _BLOCK // width)
    for first in range(0, height, rows):
        yield slice(first, min(first + rows, height))


def develop(light: Light, first: int, chip: Chip, rng: Rng | None, image: Image) -> None:
    """Writes into the image (H, W, 3) what a chip makes of the light (h, W, 3) on rows from `first` on.

    The light is overwritten. rng: None where the chip adds no noise.
    """
    rows, (height, width, _) = slice(first, first + len(light)), image.shape
    if chip.vignetting:
        light *= falloff(width, height, chip.vignetting)[rows]
    if chip.noisy and rng is not None:
        add_noise(light, chip, rng)
    if (chip.gain, chip.gamma, chip.bits) == _LINEAR:
        light += 0.5
        image[rows] = np.clip(light, 0.0, 255.0, out=light)
    else:
        light *= _STEPS
        light += 0.5
        np.clip(light, 0.0, _FULL - 1, out=light)
        levels(chip.gain, chip.gamma, chip.bits).take(light.astype(np.uint16), out=image[rows])


def add_noise(light: Light, chip: Chip, rng: Rng) -> None:
    """Adds normal noise to light: of a variance of its own, and of one that grows with the light."""
    noise = normal(light.size, rng).reshape(light.shape)
    read, shot = 255.0 * chip.read_noise, 255.0 * chip.shot_noise
    if not shot:
        noise *= np.float32(read)
    else:
        noise *= np.sqrt(light * np.float32(shot * shot / 255.0) + np.float32(read * read))
    light += noise


def normal(size: int, rng: Rng) -> Light:
    """Returns (size,) normal numbers to 12 bits, five times as quickly as the generator's own."""
    draws = np.frombuffer(rng.bytes(2 * size), "<u2") >> 4
    return quantiles().take(draws)


@cache
def quantiles() -> Light:
    """Returns (4096,) normal numbers, the middles of parts of equal probability, scaled to variance 1."""
    from statistics import NormalDist

    half = [NormalDist().inv_cdf((k + 0.5) / _DRAWS) for k in range(_DRAWS // 2)]
    values = np.array(half + [-value for value in reversed(half)])
    return np.asarray(values / values.std(), np.float32)


@cache
def falloff(width: int, height: int, vignetting: float) -> Light:
    """Returns (H, W, 1) what vignetting leaves of the light."""
    x, y = np.arange(width) - (width - 1) / 2, np.arange(height) - (height - 1) / 2
    square: Array = (x**2 + y[:, None] ** 2) / (x[0] ** 2 + y[0] ** 2)
    return np.asarray(1.0 - vignetting * square, np.float32)[..., None]


@cache
def levels(gain: float, gamma: float, bits: int) -> Image:
    """Returns (4096,) the grey level of each value of the converter."""
    light = np.clip(gain * np.arange(_FULL) / (255.0 * _STEPS), 0.0, 1.0)
    top = 2**bits - 1
    return np.asarray(np.rint(np.rint(light ** (1.0 / gamma) * top) * (255.0 / top)), np.uint8)
