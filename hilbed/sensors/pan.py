"""The axis that turns the camera: fixed, scanning at a constant rate, or tracking a beacon."""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign
from typing import Protocol

from hilbed.angles import wrap
from hilbed.clock import seconds
from hilbed.sensors.pan_spec import AnyPan, FixedSpec, Limits, ScanningSpec, TrackingSpec
from hilbed.types import Nanos, ScenarioError
from hilbed.vision.seams import Detection


class Pan(Protocol):
    def turn(self, t: Nanos) -> float:
        """Returns the pan angle (rad, robot's frame) at t, which never decreases from call to call."""
        ...

    def saw(self, detections: Sequence[Detection]) -> None:
        """Takes what the frame exposed at the last `turn` has shown."""
        ...


class Fixed:
    """Looks in one direction."""

    def __init__(self, spec: FixedSpec) -> None:
        self._angle = spec.angle

    def turn(self, t: Nanos) -> float:  # noqa: ARG002
        return self._angle

    def saw(self, detections: Sequence[Detection]) -> None:
        pass


class Scanning:
    """Turns at a constant rate, round and round or to and fro between limits."""

    def __init__(self, spec: ScanningSpec) -> None:
        self._spec = spec

    def turn(self, t: Nanos) -> float:
        spec = self._spec
        angle = spec.angle + spec.rate * seconds(t)
        return angle if spec.limits is None else fold(angle, spec.limits)

    def saw(self, detections: Sequence[Detection]) -> None:
        pass


class Tracking:
    """Turns towards the beacon it follows, as its own frames show it; scans while they do not."""

    def __init__(self, spec: TrackingSpec) -> None:
        self._spec = spec
        self._t: Nanos = 0
        self._angle = spec.angle
        self._rate = spec.rate
        self._target: float | None = None

    def turn(self, t: Nanos) -> float:
        reach = self._spec.rate * seconds(t - self._t)
        self._t = t
        if self._target is None:
            self._scan(copysign(reach, self._rate))
        else:
            way = self._way(self._target)
            self._angle += max(-reach, min(reach, way))
        return self._angle

    def saw(self, detections: Sequence[Detection]) -> None:
        last = self._angle if self._target is None else self._target
        wanted = self._spec.beacon
        azimuths = [self._angle + d.azimuth for d in detections if wanted is None or d.beacon == wanted]
        self._target = min(azimuths, key=lambda azimuth: abs(wrap(azimuth - last)), default=None)

    def _scan(self, step: float) -> None:
        limits = self._spec.limits
        angle = self._angle + step
        if limits is not None and not limits[0] <= angle <= limits[1]:
            self._rate = -self._rate
            angle = fold(angle, limits)
        self._angle = angle

    def _way(self, target: float) -> float:
        """Returns how far (rad) to turn for the target, the short way round or inside the limits."""
        limits = self._spec.limits
        if limits is None:
            return wrap(target - self._angle)
        middle = 0.5 * (limits[0] + limits[1])
        inside = middle + wrap(target - middle)
        return max(limits[0], min(limits[1], inside)) - self._angle


def fold(angle: float, limits: Limits) -> float:
    """Returns where an axis stands that would be at `angle` if it did not turn back at its limits (rad)."""
    low, high = limits
    span = high - low
    way = (angle - low) % (2.0 * span)
    return low + min(way, 2.0 * span - way)


def make_pan(spec: AnyPan, names: Sequence[int | None]) -> Pan:
    """Returns the axis that a scenario's `pan` block describes.

    names: by which index each beacon is recognised. Raises ScenarioError where the beacon to follow is not.
    """
    if isinstance(spec, FixedSpec):
        return Fixed(spec)
    if isinstance(spec, ScanningSpec):
        return Scanning(spec)
    if spec.beacon is not None and spec.beacon not in names:
        known = ", ".join(str(name) for name in names if name is not None) or "none"
        raise ScenarioError(
            f"the camera's pan axis is to follow beacon {spec.beacon}, which it cannot recognise (known by a "
            f"colour of their own: {known}); without `beacon` it follows the one nearest to its last"
        )
    return Tracking(spec)
