"""Following a line y = ȳ by curvature alone: Ishikawa & Sampei (1994), eq. (21)."""

from __future__ import annotations

from math import copysign, cos, pi, sin
from typing import Annotated, Literal

from pydantic import Field

from hilbed.angles import wrap
from hilbed.spec import Finite, Spec
from hilbed.types import Command, Estimate, Nanos

Gain = Annotated[float, Field(gt=-1e4, lt=0)]


class PathFollowingSpec(Spec):
    """y: of the line (m); speed m/s, negative to drive backwards; F1 (1/m²), F2 (1/m) per metre of travel.

    The roots of s² − F2 s − F1 are the poles; −4 and −4 put both at −2/m, in either direction.
    """

    kind: Literal["path_following"] = "path_following"
    y: Finite = 1.5
    speed: Annotated[float, Field(ge=-100, le=100)] = 1.0
    F1: Gain = -4.0
    F2: Gain = -4.0


def path_curvature(error: float, heading: float, F1: float, F2: float) -> float:
    """Returns the curvature u (1/m) of the travel, cos³θ (F₁ (y − ȳ) + F₂ tan θ), either way along the line.

    error: y − ȳ (m); heading: θ of the travel (rad). Written without the tangent, so that it is finite, and
    zero, where the travel is square to the line; gains are per metre along the line, whichever way it goes:
    then y − ȳ obeys e'' = F₁ e + F₂ e'.
    """
    c, s = cos(heading), sin(heading)
    return c * c * c * F1 * error + c * c * copysign(1.0, c) * F2 * s


class PathFollowing:
    """Speed as told, yaw rate from the curvature; drives on along the line, whichever way the robot faces.

    `beyond`: cycles in which the travel was square to the line to rounding, where the law can do nothing.
    """

    def __init__(self, spec: PathFollowingSpec) -> None:
        self._spec = spec
        self.beyond = 0

    def counts(self) -> dict[str, float]:
        """Returns in how many cycles the law was asked for what it was not made for."""
        return {"beyond": self.beyond}

    def step(self, t: Nanos, estimate: Estimate) -> Command:  # noqa: ARG002
        """Returns v (m/s) and w (rad/s) for the period from `t`."""
        _, y, yaw = estimate.mean.tolist()
        spec = self._spec
        heading = wrap(yaw + pi) if spec.speed < 0 else yaw
        self.beyond += abs(cos(heading)) < 1e-3
        u = path_curvature(y - spec.y, heading, spec.F1, spec.F2)
        return Command(spec.speed, abs(spec.speed) * u)
