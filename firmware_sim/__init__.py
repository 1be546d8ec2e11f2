"""The firmware of one simulated drive: passive, fed with frames and ticks, standard library only."""

from __future__ import annotations

from firmware_sim.drive import Drive
from firmware_sim.frame import Frame

__all__ = ["Drive", "Frame"]
