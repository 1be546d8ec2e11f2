"""No pose control: the reference's speeds, whatever the pose."""

from __future__ import annotations

from typing import Literal

from hilbed.ports import Reference
from hilbed.spec import Spec
from hilbed.types import Command, Estimate, Nanos


class OpenLoopSpec(Spec):
    """Sends the reference's speeds; how far the robot strays is what its drives and ground make of them."""

    kind: Literal["open_loop"] = "open_loop"


class OpenLoop:
    """The reference's v (m/s) and w (rad/s) at each period's start; without a reference, stands still."""

    def __init__(self, reference: Reference | None) -> None:
        self._reference = reference

    def step(self, t: Nanos, estimate: Estimate) -> Command:  # noqa: ARG002
        """Returns the reference's speeds at `t`."""
        if self._reference is None:
            return Command(0.0, 0.0)
        _, v, w = self._reference.at(t)
        return Command(v, w)
