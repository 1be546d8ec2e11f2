"""The node of an axis in profile position mode (CiA 402): targets are set-points, taken by a handshake."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hilbed.can.axis import STATUS, Axis
from hilbed.can.cia402 import ENABLE_OPERATION, QUICK_STOP
from hilbed.can.station import Station
from hilbed.types import Frame

NEW, AT_ONCE = 0x0010, 0x0020
"""Of the controlword: a set-point is there, as the bit rises; it counts before the last one is reached."""
ACKNOWLEDGED = 0x1000
"""Of the statusword."""


class SetPointStation(Station):
    """Offers the latest target as soon as the drive has let go of the one before."""

    __slots__ = ("_offered",)

    def __init__(self, axes: Sequence[Axis]) -> None:
        super().__init__(axes)
        self._offered: int | None = None

    def orders(self) -> Iterator[Frame]:
        """Yields the RPDOs, in which the target stays what was offered last."""
        if self.controlword != QUICK_STOP:
            self._shake()
        yield from super().orders()

    def _shake(self) -> None:
        (axis,) = self.axes
        raised, acknowledged = self.controlword & NEW, axis.values[STATUS] & ACKNOWLEDGED
        if raised and acknowledged:
            self.controlword = ENABLE_OPERATION
        elif not raised and not acknowledged and axis.raw != self._offered:
            self.controlword = ENABLE_OPERATION | NEW | AT_ONCE
            self._offered = axis.raw
        if self._offered is not None:
            axis.raw = self._offered
