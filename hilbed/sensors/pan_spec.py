"""The `pan` block of a camera: how the axis moves that turns it."""

from __future__ import annotations

from typing import Annotated, Literal, Self, TypeAlias

from pydantic import Field, model_validator

from hilbed.spec import Finite, Point, Positive, Spec, Word

Limits: TypeAlias = Point


class FixedSpec(Spec):
    """A camera that looks along `angle` (rad, robot's frame)."""

    kind: Literal["fixed"] = "fixed"
    angle: Finite = 0.0


class _Turning(Spec):
    """An axis that starts at `angle` and stays inside `limits` (both rad, robot's frame)."""

    angle: Finite = 0.0
    limits: Limits | None = None

    @model_validator(mode="after")
    def _starts_inside(self) -> Self:
        if self.limits is None:
            return self
        low, high = self.limits
        if not low < high:
            raise ValueError(f"limits must increase, not {low:g}, {high:g}")
        if not low <= self.angle <= high:
            raise ValueError(f"the first angle {self.angle:g} lies outside the limits {low:g}, {high:g}")
        return self


class ScanningSpec(_Turning):
    """A camera that turns on and on, or to and fro between limits, at `rate` (rad/s, left positive)."""

    kind: Literal["scanning"] = "scanning"
    rate: Finite = 1.0


class TrackingSpec(_Turning):
    """A camera that turns towards a beacon it sees, scanning while it sees none, at `rate` (rad/s) at most.

    beacon: index of the one to follow; None: the one nearest to where it looked last.
    """

    kind: Literal["tracking"] = "tracking"
    rate: Positive = 1.0
    beacon: Annotated[int, Field(ge=0)] | None = None


AnyPan: TypeAlias = FixedSpec | ScanningSpec | TrackingSpec
PanSpec: TypeAlias = Annotated[AnyPan, Field(discriminator="kind"), Word]
