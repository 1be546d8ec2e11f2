"""Random frames and pins into a drive; prints a digest of all that it does, and whether it is compiled.

Run it twice, from the sources and compiled: `python -m tests.firmware.twin SEED` (HILBED_COMPILED=no or not).
"""

from __future__ import annotations

import sys
from hashlib import sha256

from hilbed import compiled

TICKS = 0.3  # ticks a frame
FRAMES = 25_000


def digest(seed: int) -> str:
    """Returns the SHA-256 of duties, states, references and frames of a drive that hears noise."""
    from firmware_sim import Drive
    from tests.firmware.noise import Noise
    from tests.firmware.wire import MILLISECOND, NODE

    noise, drive, sha, t = Noise(seed), Drive(NODE), sha256(), 0
    for _ in range(FRAMES):
        drive.on_frame(t, noise.frame())
        if noise.random.random() < TICKS:
            inputs = noise.inputs()
            if inputs is not None:
                drive.read(inputs)
            duty = drive.tick(t, *noise.pins())
            sha.update(repr((duty, int(drive.state), drive.speed_ref, drive.malformed)).encode())
            t += MILLISECOND
        sha.update(repr([tuple(frame) for frame in drive.outbox]).encode())
        drive.outbox.clear()
    return sha.hexdigest()


if __name__ == "__main__":
    compiled.prefer()
    print(digest(int(sys.argv[1])), compiled.active())
