"""Control by a cloud: one command for each particle, and of these the one with most support."""

from __future__ import annotations

from hilbed.control.cloud_spec import CloudSpec
from hilbed.control.stabilisation import Gains, stabilising, within_wheel_limit
from hilbed.control.support import most_supported
from hilbed.ports import Reference
from hilbed.types import Command, Estimate, Nanos


class CloudControl:
    """Drives to the reference's pose; Lages & Alves (2017), "Control using a cloud of particles".

    Support is counted among commands as the law gives them; the chosen one is then limited. An estimate
    without a cloud is a cloud of one particle, its mean.
    """

    def __init__(self, spec: CloudSpec, reference: Reference) -> None:
        self._reference = reference
        self._gains = Gains(spec.gamma_1, spec.gamma_2, spec.h, spec.guard)
        self._radii = spec.radii
        self._limit = spec.half_track, spec.wheel_speed

    def step(self, t: Nanos, estimate: Estimate) -> Command:
        """Returns the command for the period from `t`."""
        cloud = estimate.mean[None] if estimate.cloud is None else estimate.cloud
        u1, u2 = stabilising(cloud, self._reference.at(t).pose, self._gains)
        best = most_supported(u1 / self._radii[0], u2 / self._radii[1])
        return within_wheel_limit(Command(float(u1[best]), float(u2[best])), *self._limit)
