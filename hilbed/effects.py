"""What disturbances do right now: they write it, plant and sensors read it, the controller never sees it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple, Protocol

from hilbed.types import Nanos, Pose, Rng


class FrameFault(NamedTuple):
    """What happens to some of the frames on the bus: those of a node, or with an identifier, or all (None).

    action: drop (never sent), delay (sent later by `delay`, ns), duplicate (sent twice), corrupt (a bit is
    inverted on the bus), silence (drop, of heartbeats alone); probability: of each frame, of each attempt
    where it is corrupt; rng: for that.
    """

    action: Literal["drop", "delay", "duplicate", "corrupt", "silence"]
    node: str | None
    identifier: int | None
    probability: float
    rng: Rng
    delay: Nanos = 0


class Babble(NamedTuple):
    """A stranger on the bus that sends frames of 8 bytes with one identifier every `period` (ns)."""

    identifier: int
    period: Nanos


class Effects:
    """The knobs of one tick; wheels in the order of the robot's drives.

    load_torque: N m at each drive, positive against forward rotation; friction: coefficient under each
    wheel, those without a drive last; radius: factor on each drive's rolling radius; push: force (N, N) in
    the map on the body's centre of mass and torque (N m) about z; supply_drop: V off the supply's
    open-circuit voltage; command: added to the controller's (m/s, and rad/s, or rad of steering);
    spurious: mean number of false azimuths a frame; blind: the camera delivers nothing; lost, broken: names
    of sensors that deliver nothing, or NaN; frames, babble: what happens on the bus; bus_off, unpowered:
    names of nodes whose CAN controller, or whose logic, is off.
    """

    __slots__ = (
        "_drives", "_friction", "babble", "blind", "broken", "bus_off", "command", "frames", "friction",
        "load_torque", "lost", "push", "radius", "spurious", "supply_drop", "unpowered",
    )  # fmt: skip

    def __init__(self, friction: Sequence[float], drives: int | None = None) -> None:
        """friction: under each wheel without disturbances; drives: how many, if not as many as wheels."""
        self._friction = list(friction)
        self._drives = len(self._friction) if drives is None else drives
        self.load_torque: list[float] = []
        self.friction: list[float] = []
        self.radius: list[float] = []
        self.frames: list[FrameFault] = []
        self.babble: list[Babble] = []
        self.lost: set[str] = set()
        self.broken: set[str] = set()
        self.bus_off: set[str] = set()
        self.unpowered: set[str] = set()
        self.reset()

    def reset(self) -> None:
        """Takes every knob back to what it is without disturbances."""
        self.load_torque[:] = [0.0] * self._drives
        self.friction[:] = self._friction
        self.radius[:] = [1.0] * self._drives
        self.push: tuple[float, float, float] = (0.0, 0.0, 0.0)
        self.supply_drop = 0.0
        self.command: tuple[float, float] = (0.0, 0.0)
        self.spurious = 0.0
        self.blind = False
        for knob in (self.frames, self.babble, self.lost, self.broken, self.bus_off, self.unpowered):
            knob.clear()


class Surroundings(Protocol):
    """What a disturbance may look at: where the robot is and where each wheel touches the ground (m, map)."""

    @property
    def pose(self) -> Pose: ...

    @property
    def wheels(self) -> Sequence[tuple[float, float]]: ...
