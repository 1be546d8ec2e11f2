"""The bench's side of firmware that is elsewhere: power, pins and answers of every such drive."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from hilbed.can import terminal
from hilbed.can.node import Node
from hilbed.can.terminal import Answer
from hilbed.clock import seconds
from hilbed.types import BusError, Frame, Nanos

PATIENCE = 5.0
"""s of the wall clock; firmware that has not answered by then is gone."""
REPEAT = 0.5
"""s after which firmware that has not come up yet is switched on again."""
_OPEN = Answer(0, False, False, 0xFF, 0)

Send = Callable[[Frame], None]
Pull = Callable[[Nanos, float], None]
"""Takes in what has come, terminal frames by way of `Terminals.take`; waits for at most so many s."""


class Terminal:
    """The pins of one firmware; `answer` is the last one, in lockstep that of this very tick.

    late: ticks whose answer had not come when the next was due; repeated: answers that came twice.
    """

    def __init__(self, node: Node, send: Send) -> None:
        self.node = node
        self.answer = _OPEN
        self.powered = self.gone = False
        self.late = self.repeated = 0
        self._send = send
        self._counter = _OPEN.counter  # of the last pins that were sent

    @property
    def answered(self) -> bool:
        """Whether the answer to the last pins is here, or none is awaited any more."""
        return self.answer.counter == self._counter or self.gone

    def power(self) -> None:
        """Switches the firmware off and on."""
        self._send(terminal.power(self.node.id))

    def present(self, counts: int, current: int, supply: int) -> None:
        """Shows the pins of a tick: counts (I32), mA (I16), quarters of a volt (U8)."""
        if self.gone:
            return
        self._counter = self._counter + 1 & 0xFF
        self._send(terminal.pins(self.node.id, counts, current, supply, self._counter))

    def read(self, inputs: int) -> None:
        """Shows digital inputs (bits of 60FD) that have changed, before the pins of a tick."""
        if not self.gone:
            self._send(terminal.inputs(self.node.id, inputs))

    def take(self, data: bytes) -> None:
        """Takes what the firmware has sent; what is malformed or old changes nothing."""
        if not data:
            self.powered = True
            return
        answer = terminal.answer(data)
        if answer is None:
            return
        newer = answer.counter - self.answer.counter & 0xFF
        self.repeated += newer == 0
        if 0 < newer < 0x80:
            self.answer = answer

    def note_late(self) -> None:
        """Counts a tick that begins without the answer to the one before; what was last heard holds."""
        self.late += self._counter - self.answer.counter & 0xFF > 1

    def lose(self) -> None:
        """Gives the firmware up: its chopper is open from now on."""
        self.gone = True
        self.answer = _OPEN


class Terminals:
    """All firmware that is elsewhere.

    send: of the bus that carries terminal frames; pull: takes in what comes; clock: s, steady; lockstep:
    whether a tick waits for its answers.
    """

    def __init__(
        self, nodes: Sequence[Node], send: Send, pull: Pull, clock: Callable[[], float], lockstep: bool
    ) -> None:
        self.by_node = {node.id: Terminal(node, send) for node in nodes}
        self._pull = pull
        self._clock = clock
        self._lockstep = lockstep

    def take(self, frame: Frame) -> bool:
        """Takes a terminal frame, whoever's; False for any other frame."""
        if not terminal.is_terminal(frame):
            return False
        number = terminal.answering(frame)
        one = None if number is None else self.by_node.get(number)
        if one is not None:
            one.take(frame.data)
        return True

    def power(self, t: Nanos, going: Callable[[], None]) -> None:
        """Switches all firmware on; BusError with those that do not come up.

        going: asked again and again; raises where that is to end.
        """
        deadline = self._clock() + PATIENCE
        while missing := [one for one in self.by_node.values() if not one.powered]:
            going()
            left = deadline - self._clock()
            if left <= 0.0:
                raise BusError(_dead(missing))
            for one in missing:
                one.power()
            self._until(t, lambda: all(one.powered for one in missing), min(left, REPEAT))

    def collect(self, t: Nanos) -> None:
        """Waits in lockstep until all pins of the tick at `t` are answered; in real time takes what is there.

        BusError where firmware falls silent in lockstep, or two processes answer under one number.
        """
        ones = self.by_node.values()
        if not self._lockstep:
            self._pull(t, 0.0)
            for one in ones:
                one.note_late()
            return
        if not self._until(t, lambda: all(one.answered for one in ones), PATIENCE):
            silent = [one for one in ones if not one.answered]
            for one in silent:
                one.lose()
            raise BusError(
                f"t = {seconds(t):g} s: {_names(silent)}: no answer to the pins within {PATIENCE:g} s: "
                "has its firmware ended?"
            )
        twice = [one for one in ones if one.repeated]
        if twice:
            raise BusError(f"t = {seconds(t):g} s: {_names(twice)}: two processes are its firmware")

    def _until(self, t: Nanos, done: Callable[[], bool], timeout: float) -> bool:
        """Takes in what comes until something is the case; False after `timeout` s."""
        deadline = self._clock() + timeout
        while not done():
            left = deadline - self._clock()
            if left <= 0.0:
                return False
            self._pull(t, left)
        return True


def _names(ones: Sequence[Terminal]) -> str:
    return ", ".join(str(one.node) for one in ones)


def _dead(ones: Sequence[Terminal]) -> str:
    number = ones[0].node.id
    return (
        f"{_names(ones)}: its firmware does not come up within {PATIENCE:g} s; start it with "
        f"`python -m firmware_sim --node {number}` on the same interface and channel"
    )
