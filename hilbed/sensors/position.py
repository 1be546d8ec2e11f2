"""A sensor of position: satellites, or cameras that look at markers on the robot."""

from __future__ import annotations

from math import cos, pi, sin
from typing import Annotated, Literal

from pydantic import Field

from hilbed.sensors.direct import DirectSpec, Look, Quantity
from hilbed.spec import NonNegative, Positive
from hilbed.types import Pose


class PositionSpec(DirectSpec):
    """Position of the axle's midpoint, in the map.

    noise: m, standard deviation of each coordinate; yaw_noise: rad, then yaw is measured as well (readings
    of kind pose instead of position), null for not; front: m ahead of the axle, a second marker (readings of
    kind front besides), null for none.
    """

    kind: Literal["position"] = "position"
    noise: NonNegative = 0.1
    yaw_noise: Annotated[NonNegative, Field(le=pi)] | None = None
    front: Positive | None = None

    def kinds(self) -> dict[str, int]:
        """Returns what it measures, with the number of components."""
        body = {"position": 2} if self.yaw_noise is None else {"pose": 3}
        return body if self.front is None else body | {"front": 2}


def position(spec: PositionSpec) -> Look:
    """Returns what there is to be read of a pose."""
    spread = (spec.noise, spec.noise)

    def look(pose: Pose) -> list[Quantity]:
        if spec.yaw_noise is None:
            found = [Quantity("position", (pose.x, pose.y), spread)]
        else:
            found = [Quantity("pose", tuple(pose), (*spread, spec.yaw_noise))]
        if spec.front is not None:
            x, y = pose.x + spec.front * cos(pose.yaw), pose.y + spec.front * sin(pose.yaw)
            found.append(Quantity("front", (x, y), spread))
        return found

    return look
