"""What the axis shows of itself: statusword and actual values, computed when somebody asks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from firmware_sim.cia402 import State
from firmware_sim.entry import key
from firmware_sim.objects.profile import HOMING, PROFILE_VELOCITY

if TYPE_CHECKING:
    from firmware_sim.axis import Axis

VOLTAGE: Final = 0x0010
REMOTE: Final = 0x0200
TARGET_REACHED: Final = 0x0400
LIMITED: Final = 0x0800
SPEED_ZERO: Final = 0x1000  # in PV
FOLLOWING: Final = 0x1000  # in CSV and CSP
ATTAINED: Final = 0x1000  # in HOMING

_STATUS, _DEMAND, _VELOCITY, _POSITION = key(0x6041), key(0x606B), key(0x606C), key(0x6064)
_TORQUE, _CURRENT, _DC_LINK = key(0x6077), key(0x6078), key(0x6079)
_POSITION_DEMAND, _FOLLOWING_ERROR = key(0x6062), key(0x60F4)
_MODE, _TARGET = key(0x6061), key(0x60FF)
_ENABLED: Final = State.ENABLED  # bound: a look-up of a member takes time
# Limits of the objects; those that numbers are compared with are of their own type, which is faster.
_I16, _I32 = 32767.0, 2147483647.0
_LEAST, _MOST = -(1 << 31), (1 << 31) - 1


def _rounded(value: float, most: float) -> int:
    if not -most <= value <= most:
        value = most if value > 0.0 else -most
    return round(value)


def statusword(axis: Axis) -> int:
    """Returns the statusword (6041)."""
    state, speed, settings = axis.state, axis.meter.speed, axis.settings
    word = state | REMOTE
    if axis.supply >= settings.least:
        word |= VOLTAGE
    if axis.clipped or axis.limited:
        word |= LIMITED
    threshold = settings.threshold
    slow = -threshold <= speed <= threshold
    cyclic = axis.values[_MODE] != PROFILE_VELOCITY
    going = axis.stop is None and not axis.halted
    if not going and slow:
        word |= TARGET_REACHED
    if cyclic:
        if axis.values[_MODE] == HOMING:
            return word | (ATTAINED | TARGET_REACHED if axis.positioner.homed else 0)
        if going and state is _ENABLED:
            word |= FOLLOWING
        return word
    if slow:
        word |= SPEED_ZERO
    if going and state is _ENABLED:
        target, _, _ = axis.plan
        if axis.speed_ref == target and abs(speed - target) <= settings.window:
            word |= TARGET_REACHED
    return word


def refresh(axis: Axis) -> None:
    """Writes statusword and actual values into the dictionary, in the units and signs of the bus."""
    values, settings = axis.values, axis.settings
    unit, current = settings.unit, axis.current
    values[_STATUS] = statusword(axis)
    values[_DEMAND] = _rounded(axis.speed_ref / unit, _I32)
    values[_VELOCITY] = _rounded(axis.meter.speed / unit, _I32)
    position = axis.counts * settings.polarity + axis.positioner.home
    if not _LEAST <= position <= _MOST:  # mirrored, the lowest count has no counterpart
        position = (position - _LEAST) % (1 << 32) + _LEAST
    values[_POSITION] = position
    if axis.positioner.active:
        demand, error = axis.positioner.shown(settings)
        values[_POSITION_DEMAND], values[_FOLLOWING_ERROR] = _rounded(demand, _I32), _rounded(error, _I32)
    values[_TORQUE] = _rounded(current * settings.torque_scale, _I16)
    values[_CURRENT] = _rounded(current * settings.current_scale, _I16)
    values[_DC_LINK] = axis.supply * 250
