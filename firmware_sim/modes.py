"""Modes of operation: what each makes of the target. A new mode is a function and a row."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import TypeAlias

from firmware_sim.cia402 import Ramp
from firmware_sim.objects.profile import (
    CYCLIC_POSITION,
    CYCLIC_VELOCITY,
    HOMING,
    NO_MODE,
    PROFILE_POSITION,
    PROFILE_VELOCITY,
)
from firmware_sim.settings import Settings

Plan: TypeAlias = tuple[float, float, float]
"""Where the speed reference goes (rad/s) and how fast (rad/s a tick, growing and shrinking).

A plain tuple: it is taken apart in every tick.
"""


def stopping(settings: Settings, ramp: Ramp) -> Plan:
    """Returns the plan that ends at rest."""
    fall = settings.falls[ramp]
    return 0.0, fall, fall


def _none(settings: Settings, _target: float) -> Plan:
    return stopping(settings, Ramp.SLOW)


def _profile_velocity(settings: Settings, target: float) -> Plan:
    return target, settings.rise, settings.falls[Ramp.SLOW]


def _cyclic_velocity(settings: Settings, target: float) -> Plan:
    return target, settings.slew, settings.slew


def _position(_settings: Settings, _target: float) -> Plan:
    """The position loop says in every tick where the speed goes."""
    return 0.0, inf, inf


def _homing(settings: Settings, _target: float) -> Plan:
    """The search says where the speed goes; it is ramped here."""
    return 0.0, settings.homing_ramp, settings.homing_ramp


MODES: dict[int, Callable[[Settings, float], Plan]] = {
    NO_MODE: _none,
    PROFILE_POSITION: _position,
    PROFILE_VELOCITY: _profile_velocity,
    HOMING: _homing,
    CYCLIC_POSITION: _position,
    CYCLIC_VELOCITY: _cyclic_velocity,
}
