"""Parameters of the axis, read once from the object dictionary after every change: radians and ticks."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from firmware_sim.cia402 import Ramp
from firmware_sim.entry import key
from firmware_sim.error_rate import TICK
from firmware_sim.loops import Gains, RelayGains, SpeedLoop, make_loop
from firmware_sim.motor_model import MotorModel
from firmware_sim.position import PositionLoop

Values = dict[int, Any]

_VELOCITY_REVERSED, _POSITION_REVERSED = 0x40, 0x80


class Settings(NamedTuple):
    """unit: rad/s of one count/s; polarity: ±1, of the position; max_speed, threshold, window: rad/s;
    rise, slew and falls: rad/s a tick; trip: mA; least: quarters of a volt; torque_scale, current_scale:
    per mille of the rated value a mA. unit and both scales are negative where velocities are reversed (607E).
    lowest, highest: where a position target may be, following: how far behind the axis may be, counts;
    interpolation: ticks; homing_ramp: rad/s a tick.
    """

    unit: float
    polarity: int
    max_speed: float
    threshold: float
    window: float
    rise: float
    slew: float
    falls: dict[Ramp, float]
    trip: float
    least: float
    torque_scale: float
    current_scale: float
    lowest: float
    highest: float
    following: float
    interpolation: float
    homing_ramp: float


def read_settings(values: Values) -> Settings:
    """Returns the settings that these values mean."""
    unit = 2.0 * math.pi / values[key(0x2001)]
    direction = -1 if values[key(0x607E)] & _VELOCITY_REVERSED else 1
    slew = values[key(0x2013, 4)]
    return Settings(
        unit=unit * direction,
        polarity=-1 if values[key(0x607E)] & _POSITION_REVERSED else 1,
        max_speed=values[key(0x607F)] * unit,
        threshold=values[key(0x606F)] * unit,
        window=values[key(0x606D)] * unit,
        rise=values[key(0x6083)] * unit * TICK,
        slew=slew * TICK if slew > 0.0 else math.inf,
        falls={
            Ramp.SLOW: values[key(0x6084)] * unit * TICK,
            Ramp.QUICK: values[key(0x6085)] * unit * TICK,
            Ramp.FULL: math.inf,
        },
        trip=values[key(0x2013, 2)] * 1000.0,
        least=values[key(0x2013, 3)] * 4.0,
        torque_scale=direction * 1000.0 * values[key(0x2012, 2)] / values[key(0x6076)],
        current_scale=direction * 1000.0 / values[key(0x6075)],
        lowest=values[key(0x607D, 1)],
        highest=values[key(0x607D, 2)],
        following=values[key(0x6065)],
        interpolation=max(values[key(0x60C2, 1)] * 10.0 ** values[key(0x60C2, 2)] / TICK, 1.0),
        homing_ramp=values[key(0x609A)] * unit * TICK,
    )


def read_motor(values: Values) -> MotorModel:
    return MotorModel(values[key(0x2012, 1)], values[key(0x2012, 2)], values[key(0x2013, 1)])


def read_position(values: Values) -> PositionLoop:
    """Returns a position loop at zero."""
    unit = 2.0 * math.pi / values[key(0x2001)]
    return PositionLoop(values[key(0x2014)], unit, values[key(0x607F)] * unit)


def read_loop(values: Values) -> SpeedLoop:
    """Returns a fresh loop of the kind and with the gains that the dictionary holds."""
    gains = Gains(*(values[key(0x2010, sub)] for sub in range(2, 12)))
    relay = RelayGains(*(values[key(0x2011, sub)] for sub in range(1, 4)))
    return make_loop(values[key(0x2010, 1)], gains, relay)
