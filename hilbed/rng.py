"""One stream of random numbers a source, so that adding a source changes nobody else's noise."""

from __future__ import annotations

from zlib import crc32

import numpy as np


def stream(seed: int, name: str) -> np.random.Generator:
    """Returns the generator of the source `name` in the run with `seed`: the same in every process."""
    sequence = np.random.SeedSequence(seed, spawn_key=(crc32(name.encode()),))
    return np.random.Generator(np.random.PCG64(sequence))
