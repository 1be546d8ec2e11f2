"""One stream of random numbers a source, so that adding a source changes nobody else's noise."""

from __future__ import annotations

from zlib import crc32

import numpy as np


def stream(seed: int, name: str, *parts: int) -> np.random.Generator:
    """Returns the generator of the source `name` in the run with `seed`: the same in every process.

    parts: not negative, for one of many things of the source, such as the time of a frame.
    """
    sequence = np.random.SeedSequence(seed, spawn_key=(crc32(name.encode()), *parts))
    return np.random.Generator(np.random.PCG64(sequence))
