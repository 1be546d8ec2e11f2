"""What the axis shows of itself: statusword and actual values, computed when somebody asks."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from firmware_sim.cia402 import State
from firmware_sim.entry import key
from firmware_sim.objects.profile import CYCLIC_POSITION, HOMING, PROFILE_POSITION, PROFILE_VELOCITY

if TYPE_CHECKING:
    from firmware_sim.axis import Axis

VOLTAGE: Final = 0x0010
REMOTE: Final = 0x0200
TARGET_REACHED: Final = 0x0400
LIMITED: Final = 0x0800
SPEED_ZERO: Final = 0x1000  # in PV
FOLLOWING: Final = 0x1000  # in CSV and CSP
ATTAINED: Final = 0x1000  # in HOMING
ACKNOWLEDGED: Final = 0x1000  # in PP
LAGGING: Final = 0x2000  # in PP and CSP
NOT_FOUND: Final = 0x2000  # in HOMING

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
    mode = axis.values[_MODE]
    going = axis.stop is None and not axis.halted
    if not going and slow:
        word |= TARGET_REACHED
    if mode != PROFILE_VELOCITY:
        if mode in _POSITIONED:
            return word | _POSITIONED[mode](axis, slow)
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


def _homing(axis: Axis, slow: bool) -> int:
    """Bits 13, 12, 10: none of them on the way, 10 alone where no search is on."""
    homing = axis.positioner.homing
    if homing.searching:
        return 0
    found = NOT_FOUND if homing.failed else ATTAINED if axis.positioner.place.homed else 0
    return found | TARGET_REACHED if slow else found


def _profile(axis: Axis, _: bool) -> int:
    profile = axis.positioner.profile
    word = ACKNOWLEDGED if profile.acknowledged else 0
    if profile.reached and axis.positioner.active:
        word |= TARGET_REACHED
    return word | _lagging(axis)


def _cyclic(axis: Axis, _: bool) -> int:
    going = axis.stop is None and not axis.halted
    return _lagging(axis) | (FOLLOWING if going and axis.state is _ENABLED else 0)


def _lagging(axis: Axis) -> int:
    return LAGGING if axis.positioner.place.lagging else 0


_POSITIONED: dict[int, Callable[[Axis, bool], int]] = {
    PROFILE_POSITION: _profile,
    HOMING: _homing,
    CYCLIC_POSITION: _cyclic,
}
"""What the statusword shows in each position mode; slow: whether the axis stands."""


def refresh(axis: Axis) -> None:
    """Writes statusword and actual values into the dictionary, in the units and signs of the bus."""
    values, settings = axis.values, axis.settings
    unit, current = settings.unit, axis.current
    values[_STATUS] = statusword(axis)
    values[_DEMAND] = _rounded(axis.speed_ref / unit, _I32)
    values[_VELOCITY] = _rounded(axis.meter.speed / unit, _I32)
    place = axis.positioner.place
    position = axis.counts * settings.polarity + place.home
    if not _LEAST <= position <= _MOST:  # mirrored, the lowest count has no counterpart
        position = (position - _LEAST) % (1 << 32) + _LEAST
    values[_POSITION] = position
    if axis.positioner.active:
        loop = place.loop
        values[_POSITION_DEMAND] = _rounded(place.position(loop.demand), _I32)
        values[_FOLLOWING_ERROR] = _rounded(loop.error * settings.polarity, _I32)
    values[_TORQUE] = _rounded(current * settings.torque_scale, _I16)
    values[_CURRENT] = _rounded(current * settings.current_scale, _I16)
    values[_DC_LINK] = axis.supply * 250
