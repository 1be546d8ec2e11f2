"""Arrays of angles live in (−π, π] too."""

from __future__ import annotations

import numpy as np

from hilbed.types import Array


def wrap(angle: Array) -> Array:
    """Returns angles (rad) of any shape in (−π, π]."""
    return angle - 2 * np.pi * np.ceil((angle - np.pi) / (2 * np.pi))


def sinc(angle: Array) -> Array:
    """Returns sin(h)/h of angles h (rad) of any shape, 1 at h = 0."""
    return np.sinc(angle / np.pi)
