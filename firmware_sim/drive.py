"""One drive: a CANopen node and the axis behind it, fed with frames and ticks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from firmware_sim.axis import Axis
from firmware_sim.cia402 import State
from firmware_sim.dictionary import ObjectDictionary
from firmware_sim.errors import Errors
from firmware_sim.frame import AnyFrame, Frame
from firmware_sim.node import Accept, Node


class Drive:
    """The firmware of one wheel: passive, without threads and without a clock of its own.

    The owner calls `tick` every millisecond and `on_frame` for every frame on the bus, and after each
    takes the frames to send out of `outbox`, which stays the same list. Power comes with the first tick,
    which sends the boot-up message. node: 1 to 127; accept: told the identifiers that the drive heeds, from
    power-on and whenever they change, for the acceptance filter of a CAN controller. Extended frames are
    never heeded. stored: what its owner has set and stored, by index and sub-index: defaults of its objects.
    """

    def __init__(
        self,
        node: int,
        accept: Accept | None = None,
        stored: Mapping[tuple[int, int], Any] | None = None,
    ) -> None:
        if not 1 <= node <= 127:
            raise ValueError(f"a node's number is 1 to 127, not {node}")
        dictionary = ObjectDictionary(node, stored)
        errors = Errors(dictionary.values)
        self._axis = Axis(dictionary.values, errors)
        self._node = Node(node, dictionary, errors, self._axis, accept)
        self._pending = errors.pending
        self.outbox: list[Frame] = self._node.outbox
        self.on_frame: Callable[[int, AnyFrame], None] = self._node.receive
        """Takes a frame off the bus at t (ns); whatever is in it, nothing is raised."""

    def tick(self, t: int, counts: int, current: int, supply: int) -> int:
        """Runs the control period at t (ns) and returns the duty in Q15, −32767 … 32767.

        What a microcontroller reads at its pins: encoder counts (I32, wrapping), motor current in mA
        (I16), supply in quarters of a volt (U8).
        """
        node, axis = self._node, self._axis
        if t >= node.due:
            node.poll(t)
        duty = axis.tick(counts, current, supply)
        if axis.event or self._pending:
            axis.event = False
            node.announce(t)
        return duty

    def read(self, inputs: int) -> None:
        """Takes the digital inputs as they are from now on: 1 negative, 2 positive limit, 4 home switch."""
        self._axis.read(inputs)

    @property
    def bridge_enabled(self) -> bool:
        """False: the chopper is open and the wheel coasts."""
        return self._axis.bridge_enabled

    @property
    def state(self) -> State:
        """Where its state machine is."""
        return self._axis.state

    @property
    def faulted(self) -> bool:
        """True in FAULT and on the way there."""
        return self._axis.faulted

    @property
    def speed_ref(self) -> float:
        """What the speed loop follows now, rad/s at the wheel in the encoder's direction; 0 when it rests."""
        return self._axis.speed_ref

    @property
    def malformed(self) -> int:
        """Frames for this node that were dropped for their length."""
        return self._node.malformed
