"""What the axis shows of itself: statusword and actual values, computed when somebody asks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from firmware_sim.cia402 import State
from firmware_sim.entry import key
from firmware_sim.objects.profile import PROFILE_VELOCITY

if TYPE_CHECKING:
    from firmware_sim.axis import Axis

VOLTAGE: Final = 0x0010
REMOTE: Final = 0x0200
TARGET_REACHED: Final = 0x0400
LIMITED: Final = 0x0800
SPEED_ZERO: Final = 0x1000  # in PV
FOLLOWING: Final = 0x1000  # in CSV

_STATUS, _DEMAND, _VELOCITY, _POSITION = key(0x6041), key(0x606B), key(0x606C), key(0x6064)
_TORQUE, _CURRENT, _DC_LINK = key(0x6077), key(0x6078), key(0x6079)
_MODE, _TARGET = key(0x6061), key(0x60FF)
_I16, _I32 = (1 << 15) - 1, (1 << 31) - 1


def _within(value: float, most: int) -> int:
    return -most if value < -most else most if value > most else round(value)


def statusword(axis: Axis) -> int:
    """Returns the statusword (6041)."""
    settings = axis.settings
    word = axis.state | REMOTE
    if axis.supply >= settings.least:
        word |= VOLTAGE
    speed = axis.meter.speed
    slow = -settings.threshold <= speed <= settings.threshold
    cyclic = axis.values[_MODE] != PROFILE_VELOCITY
    if axis.halted or axis.stop is not None:
        if slow:
            word |= TARGET_REACHED
    elif not cyclic and axis.state is State.ENABLED:
        target = axis.plan.target
        if axis.speed_ref == target and abs(speed - target) <= settings.window:
            word |= TARGET_REACHED
    if axis.clipped or abs(axis.values[_TARGET]) * settings.unit > settings.max_speed:
        word |= LIMITED
    if cyclic:
        if axis.state is State.ENABLED and axis.stop is None and not axis.halted:
            word |= FOLLOWING
    elif slow:
        word |= SPEED_ZERO
    return word


def refresh(axis: Axis) -> None:
    """Writes statusword and actual values into the dictionary, in the units and signs of the bus."""
    values, settings = axis.values, axis.settings
    direction, unit = settings.direction, settings.unit
    values[_STATUS] = statusword(axis)
    values[_DEMAND] = _within(axis.speed_ref * direction / unit, _I32)
    values[_VELOCITY] = _within(axis.meter.speed * direction / unit, _I32)
    values[_POSITION] = (axis.counts * settings.position_direction + _I32 + 1) % (2 * _I32 + 2) - _I32 - 1
    current = axis.current * direction
    values[_TORQUE] = _within(current * settings.torque_scale, _I16)
    values[_CURRENT] = _within(current * settings.current_scale, _I16)
    values[_DC_LINK] = axis.supply * 250
