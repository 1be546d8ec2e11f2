"""How well a drive keeps its speed, judged by the plant's truth at the tick."""

from __future__ import annotations

from math import inf

import numpy as np

from hilbed.criteria.consistency import spread
from hilbed.criteria.pose import largest, rms, wrapped
from hilbed.criteria.signals import Column, Missing, Signals

SETTLED = 0.02  # of the reference: the band in which a speed counts as recovered
STEADY = 0.5  # s at the end of the window, over which a duty's chatter is taken


def speed_rms_error(signals: Signals, drive: str) -> float:
    """Speed minus its reference, root mean square."""
    _turns_a_wheel(signals, drive)
    return rms(signals.drive(drive, "speed") - signals.drive(drive, "speed_ref"))


def load_dip(signals: Signals, drive: str) -> float:
    """Largest drop of the speed below its reference while a load torque is on."""
    _turns_a_wheel(signals, drive)
    loaded = under_load(signals, drive)
    return largest(np.maximum(_behind(signals, drive)[loaded], 0.0))


def load_recovery(signals: Signals, drive: str) -> float:
    """Time from the onset of a load torque until the speed stays within 2 % of its reference.

    Infinite where it does not while the load is on.
    """
    _turns_a_wheel(signals, drive)
    loaded = under_load(signals, drive)
    t = signals.drive_time(drive)[loaded]
    band = SETTLED * np.abs(signals.drive(drive, "speed_ref")[loaded])
    outside = np.flatnonzero(np.abs(_behind(signals, drive)[loaded]) > band)
    if not len(outside):
        return 0.0
    if outside[-1] + 1 >= len(t):
        return inf
    return float(t[outside[-1] + 1] - t[0])


def duty_chatter(signals: Signals, drive: str) -> float:
    """Standard deviation of the duty over the last 0.5 s of the window."""
    t, duty = signals.drive_time(drive), signals.drive(drive, "duty")
    if not len(t):
        raise Missing("the window is empty")
    return spread(duty[t >= t[-1] - STEADY])


def step_overshoot(signals: Signals, drive: str) -> float:
    """How far the speed passes the last reference of the window, as a fraction of the way to it."""
    _turns_a_wheel(signals, drive)
    speed, target = signals.drive(drive, "speed"), signals.drive(drive, "speed_ref")
    if not len(speed):
        raise Missing("the window is empty")
    way = target[-1] - speed[0]
    if abs(way) < 1e-3:
        raise Missing("the speed makes no step in the window")
    return max(0.0, largest((speed - target[-1]) / way))


def angle_rms_error(signals: Signals, drive: str) -> float:
    """Angle of a steering axis minus its reference, root mean square."""
    return rms(wrapped(signals[f"drive/{drive}/angle"] - signals[f"drive/{drive}/angle_ref"]))


def slip_max(signals: Signals, drive: str) -> float:
    """Largest speed of the wheel's surface against the ground."""
    _turns_a_wheel(signals, drive)
    return largest(np.abs(signals.drive(drive, "slip")))


def current_max(signals: Signals, drive: str) -> float:
    """Largest current of the motor."""
    return largest(np.abs(signals.drive(drive, "current")))


def duty_max(signals: Signals, drive: str) -> float:
    """Largest duty."""
    return largest(np.abs(signals.drive(drive, "duty")))


def _turns_a_wheel(signals: Signals, drive: str) -> None:
    """Raises Missing for a steering axis: its speed is its drive's own affair, and it does not roll."""
    if f"drive/{drive}/angle_ref" in signals:
        raise Missing(f"{drive} is a steering axis, which follows an angle")


def under_load(signals: Signals, drive: str) -> slice:
    """Returns the rows from the onset of a drive's load torque to its end or to its next release.

    A load begins where the torque has left its value at the start of the window by a tenth of the largest
    change, and ends where it comes back. Raises Missing where the torque does not change.
    """
    torque = signals.drive(drive, "load_torque")
    change = np.abs(torque - torque[0]) if len(torque) else torque
    peak = largest(change)
    if not peak > 1e-3:
        raise Missing(f"no load torque sets in on {drive}")
    loaded = change > 0.1 * peak
    onset = int(np.argmax(loaded))
    released = np.flatnonzero(~loaded[onset:])
    return slice(onset, onset + int(released[0]) if len(released) else len(loaded))


def _behind(signals: Signals, drive: str) -> Column:
    """Returns how far (M,) in rad/s the speed is behind its reference, in the direction of turning."""
    reference = signals.drive(drive, "speed_ref")
    return np.asarray((reference - signals.drive(drive, "speed")) * np.where(reference < 0, -1.0, 1.0))
