"""Random frames into a drive at random pins; checks what must hold and prints figures."""

from __future__ import annotations

import argparse
from collections import Counter
from time import perf_counter

from firmware_sim.cia402 import State
from tests.firmware.invariants import EDGES, Watched
from tests.firmware.noise import Noise
from tests.firmware.wire import MILLISECOND

TICKS = 0.3  # ticks a frame
LOOK = 1000  # frames between two looks at the whole dictionary


def fuzz(frames: int, seed: int) -> tuple[Watched, Counter[State]]:
    """Sends a drive so many frames; returns it and how many ticks it spent in each state.

    Raises AssertionError with the first thing that does not hold; whatever else the drive raises is its own.
    """
    noise, watched, ticks = Noise(seed), Watched(), Counter[State]()
    t = 0
    for k in range(frames):
        watched.heed(t, noise.frame())
        if noise.random.random() < TICKS:
            inputs = noise.inputs()
            if inputs is not None:
                watched.drive.read(inputs)
            watched.tick(t, noise.pins())
            ticks[watched.axis.state] += 1
            t += MILLISECOND
        if k % LOOK == 0:
            watched.check_dictionary()
    return watched, ticks


def main() -> None:
    parser = argparse.ArgumentParser(prog="scripts/firmware-fuzz", description=__doc__)
    parser.add_argument("frames", type=int, nargs="?", default=1_000_000)
    parser.add_argument("seed", type=int, nargs="?", default=1)
    options = parser.parse_args()
    frames, seed = options.frames, options.seed
    start = perf_counter()
    watched, ticks = fuzz(frames, seed)
    seconds = perf_counter() - start
    print(f"{frames} frames, {ticks.total()} ticks, seed {seed}: every invariant held, {seconds:.0f} s")
    print("ticks in", ", ".join(f"{state.name} {count}" for state, count in ticks.most_common()))
    print(f"{len(watched.edges)} of {len(EDGES)} transitions, {watched.edges.total()} times")
    print("ticks with power in mode", ", ".join(f"{mode} {n}" for mode, n in watched.modes.most_common()))
    print("sent:", ", ".join(f"{kind} {count}" for kind, count in sorted(watched.sent.items())))
    print("never taken:", ", ".join(f"{a.name}-{b.name}" for a, b in EDGES - set(watched.edges)) or "none")
    print(f"dropped for their length: {watched.drive.malformed}")


if __name__ == "__main__":
    main()
