"""Parameters of the speed loops, in the units of the objects 2010 and 2011."""

from __future__ import annotations

from typing import NamedTuple


class Gains(NamedTuple):
    """Duty per rad/s at the wheel, seconds, rad/s; defaults: Slimane et al. 2014, mended form."""

    kp: float = 0.11
    ki: float = 1.5
    slope: float = 0.03
    band_start: float = 0.05
    band_width: float = 0.2
    kp_rise: float = 3.0
    ki_rise: float = 15.0
    ki_reach: float = 2.0
    rate_filter: float = 0.005
    anti_windup: float = 20.0


class RelayGains(NamedTuple):
    """Amplitude (duty), boundary layer (rad/s), integral gain (1/s)."""

    amplitude: float = 0.15
    boundary: float = 0.3
    ki: float = 1.5
