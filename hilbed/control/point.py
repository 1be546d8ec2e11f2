"""A reference that stands: the pose to be reached."""

from __future__ import annotations

from typing import Literal

from hilbed.angles import wrap
from hilbed.control.arcs import Arc, Box, Path
from hilbed.spec import Finite, Listed, Spec
from hilbed.types import Nanos, Pose, ReferencePoint


class Standing:
    """The same pose for ever, at zero speed."""

    def __init__(self, pose: Pose) -> None:
        self._point = ReferencePoint(pose, 0.0, 0.0)

    def at(self, t: Nanos) -> ReferencePoint:  # noqa: ARG002
        """Returns the pose."""
        return self._point

    def extent(self) -> Box:
        """Returns the box (m) that the point is."""
        x, y, _ = self._point.pose
        return Box(x, y, x, y)


class PointSpec(Spec):
    """A pose (m, m, rad) to be reached and kept."""

    kind: Literal["point"]
    pose: Listed[tuple[Finite, Finite, Finite]]

    def path(self) -> Path:
        """Returns a path without length."""
        return Path(self._pose(), [Arc(0.0)], closed=False)

    def build(self) -> Standing:
        """Returns the reference."""
        return Standing(self._pose())

    def _pose(self) -> Pose:
        x, y, yaw = self.pose
        return Pose(x, y, wrap(yaw))
