"""The speed loops: each takes reference and speed (rad/s at the wheel) and gives a duty in [low, high].

All are pure: no bus, no clock, one `step` a control period of 1 ms.
"""

from __future__ import annotations

from typing import Protocol

from firmware_sim.loops.fixed_pi import FixedPi
from firmware_sim.loops.gains import Gains, RelayGains
from firmware_sim.loops.relay import Relay
from firmware_sim.loops.variable_structure import VariableStructurePi
from firmware_sim.objects.tuning import FIXED_PI, RELAY, VARIABLE_STRUCTURE


class SpeedLoop(Protocol):
    """What the drive needs of a loop."""

    def reset(self, ref: float, speed: float, duty: float) -> None:
        """Starts without a bump: the first `step` at these speeds gives about this duty."""
        ...

    def step(self, ref: float, speed: float, low: float = -1.0, high: float = 1.0) -> float: ...


def make_loop(kind: int, gains: Gains, relay: RelayGains) -> SpeedLoop:
    """Returns the loop that object 2010:1 selects."""
    loops: dict[int, SpeedLoop] = {
        VARIABLE_STRUCTURE: VariableStructurePi(gains),
        FIXED_PI: FixedPi(gains),
        RELAY: Relay(gains, relay),
    }
    return loops[kind]


__all__ = ["FixedPi", "Gains", "Relay", "RelayGains", "SpeedLoop", "VariableStructurePi", "make_loop"]
