"""Surfaces made by the program: tiles that repeat without a seam."""

from __future__ import annotations

from collections.abc import Callable
from math import tau

import numpy as np

from hilbed.scene.scenery import SurfaceSpec
from hilbed.types import Array, Image, Rng

SIZE = 256
"""Pixels along each side of a tile."""

_SEED = 1  # a pattern looks the same in every run


def tile(spec: SurfaceSpec) -> Image:
    """Returns (n, n, 3) RGB of a tile of the surface, one pixel where it is plain."""
    first, second = (255.0 * np.array(colour) for colour in (spec.colour, spec.second))
    share = PATTERNS[spec.pattern](np.random.default_rng(_SEED))[..., None]
    return np.asarray(np.clip(np.rint(first + share * (second - first)), 0, 255), np.uint8)


def _plain(_: Rng) -> Array:
    return np.zeros((1, 1))


def _checker(_: Rng) -> Array:
    half = np.arange(SIZE) * 2 // SIZE
    return np.asarray(half[:, None] ^ half, float)


def _noise(rng: Rng) -> Array:
    """Specks of all sizes up to an eighth of the tile."""
    octaves = [_smooth(rng.standard_normal((SIZE, SIZE)), width) for width in (1, 3, 9, 32)]
    return np.asarray(0.5 + 0.25 * np.sum(octaves, axis=0))


def _carpet(rng: Rng) -> Array:
    """Short fibres along both directions."""
    grain = rng.standard_normal((SIZE, SIZE))
    return 0.5 + 0.3 * (_smooth(grain, 7, axes=(0,)) + _smooth(grain.T, 5, axes=(1,)))


def _wood(rng: Rng) -> Array:
    """Eight planks, each with its own tone and a grain along it, and dark joints."""
    across = np.arange(SIZE)
    plank = across * 8 // SIZE
    tone = rng.uniform(0.0, 0.6, 8)[plank][:, None]
    grain = _smooth(_smooth(rng.standard_normal((SIZE, SIZE)), 41, axes=(1,)), 2, axes=(0,))
    rings = np.sin(tau * 3.0 * across / SIZE)[:, None]
    joint = (across % (SIZE // 8) < 2)[:, None]
    return np.where(joint, 1.6, tone + 0.15 * grain + 0.1 * rings)


def _bricks(rng: Rng) -> Array:
    """Eight courses of four bricks in running bond, each with its own tone, and light joints."""
    row, column = np.mgrid[:SIZE, :SIZE]
    course = row * 8 // SIZE
    shifted = (column + course % 2 * (SIZE // 8)) % SIZE
    tone = rng.uniform(0.3, 1.0, (8, 4))[course, shifted * 4 // SIZE]
    joint = (row % (SIZE // 8) < 2) | (shifted % (SIZE // 4) < 2)
    return np.where(joint, 0.0, tone)


PATTERNS: dict[str, Callable[[Rng], Array]] = {
    "plain": _plain, "checker": _checker, "noise": _noise,
    "carpet": _carpet, "wood": _wood, "bricks": _bricks,
}  # fmt: skip


def _smooth(noise: Array, width: int, axes: tuple[int, ...] = (0, 1)) -> Array:
    """Returns a running mean over `width` pixels, across the tile's edges too, of unit deviation."""
    for axis in axes:
        noise = np.mean([np.roll(noise, shift, axis) for shift in range(width)], axis=0)
    return np.asarray(noise / noise.std())
