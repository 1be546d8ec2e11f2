"""A CAN bus bit by bit, written from the standard alone: every node is a state machine that sees the level.

Slow and simple, an oracle for the wire. 0 is dominant. Frames are laid out and taken apart here, with nothing
of the wire's.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from hilbed.types import Frame


def bits_of(frame: Frame) -> list[int]:
    """The frame as it is sent, stuffed, recessive in the acknowledge slot."""
    if frame.extended:
        identifier = format(frame.id, "029b")
        head = f"0{identifier[:11]}11{identifier[11:]}{int(frame.remote)}00"
    else:
        head = f"0{frame.id:011b}{int(frame.remote)}00"
    plain = head + format(len(frame.data), "04b")
    if not frame.remote:
        plain += "".join(format(byte, "08b") for byte in frame.data)
    crc = 0
    for bit in plain:
        top = crc >> 14 ^ int(bit)
        crc = crc << 1 & 0x7FFF ^ (0x4599 if top else 0)
    return stuffed(plain + format(crc, "015b")) + [1] * 10


def stuffed(plain: str) -> list[int]:
    sent: list[int] = []
    for bit in plain:
        sent.append(int(bit))
        if five_alike(sent):
            sent.append(1 - sent[-1])
    return sent


def five_alike(sent: list[int]) -> bool:
    run = 0
    for bit in reversed(sent):
        if bit != sent[-1]:
            break
        run += 1
    return run % 5 == 0 if run else False


def arbitration_end(frame: Frame) -> int:
    """Index of the first bit behind the arbitration field."""
    if frame.extended:
        return len(stuffed(f"0{frame.id >> 18:011b}11{frame.id & 0x3FFFF:018b}{int(frame.remote)}"))
    return len(stuffed(f"0{frame.id:011b}{int(frame.remote)}"))


@dataclass
class Node:
    """One node; `frame` is what it sends until it is through, `done` when (bit) it was."""

    name: str
    frame: Frame | None = None
    tec: int = 0
    rec: int = 0
    done: int | None = None
    mode: str = "idle"
    seen: list[int] = field(default_factory=list)
    sending: list[int] | None = None
    left: int = 0
    run: int = 0
    last: int = 1
    active: bool = True
    transmitter: bool = False
    alone: bool = False
    errors: int = 0
    heard: list[int] = field(default_factory=list)

    @property
    def passive(self) -> bool:
        return self.tec > 127 or self.rec > 127

    def drive(self, length: int | None) -> int:
        """The level that it puts on the bus; length: of the frame on the bus, which a receiver counts."""
        if self.mode == "idle" and self.frame is not None:
            self.mode, self.sending, self.seen = "frame", bits_of(self.frame), []
            self.transmitter = True
        if self.mode == "frame":
            if self.sending is not None:
                return self.sending[len(self.seen)]
            return 0 if length is not None and len(self.seen) == length - 9 else 1
        return 0 if self.mode == "flag" and self.active else 1

    def sample(self, t: int, level: int, length: int | None) -> None:
        if self.mode in ("idle", "suspend") and level == 0:
            self.mode, self.sending, self.seen, self.transmitter = "frame", None, [], False
        if self.mode == "frame":
            self._frame(t, level, length)
        elif self.mode not in ("idle", "off"):
            {
                "flag": self._flag,
                "delimiter": self._delimiter,
                "intermission": self._wait,
                "suspend": self._wait,
            }[self.mode](level)

    def _frame(self, t: int, level: int, length: int | None) -> None:
        at = len(self.seen)
        self.seen.append(level)
        if self.sending is not None:
            self._check(t, level, at)
        elif length is None or at < length - 10:
            if len(self.seen) > 5 and len(set(self.seen[-6:])) == 1:
                self._fail(unanswered=False)
        elif at == length - 1:
            self.rec = 119 if self.rec > 127 else max(0, self.rec - 1)
            self.heard.append(t + 1)
            self._rest()

    def _check(self, t: int, level: int, at: int) -> None:
        assert self.sending is not None
        assert self.frame is not None
        acknowledge = at == len(self.sending) - 9
        if self.sending[at] != level and not acknowledge:
            if level == 0 and at < arbitration_end(self.frame):
                self.sending, self.transmitter = None, False
            else:
                self._fail(unanswered=False)
        elif acknowledge and level == 1:
            self._fail(unanswered=True)
        elif at == len(self.sending) - 1:
            self.done, self.frame, self.tec = t + 1, None, max(0, self.tec - 1)
            self._rest()

    def _fail(self, unanswered: bool) -> None:
        """The flag is as the state was before the error; a passive node that is alone counts no further."""
        self.errors += 1
        self.active = not self.passive
        if self.transmitter:
            if not (unanswered and self.passive):
                self.tec += 8
        else:
            self.rec += 1
        self.mode, self.left, self.run, self.last = "flag", 6, 0, -1

    def _flag(self, level: int) -> None:
        self.run = self.run + 1 if level == self.last else 1
        self.last = level
        self.left -= 1
        if (self.left == 0) if self.active else self.run == 6:
            self.mode, self.left, self.alone = "delimiter", 8, True

    def _delimiter(self, level: int) -> None:
        """`alone`: this is the first bit behind the flag."""
        if level == 0 and self.alone and not self.transmitter and self.active:
            self.rec += 8
        self.alone = False
        self.left -= level
        if self.left == 0:
            self._rest()

    def _rest(self) -> None:
        self.mode, self.left = "intermission", 3
        if self.tec > 255:
            self.mode, self.frame = "off", None

    def _wait(self, _: int) -> None:
        """Between frames: three bits, and eight more for a passive node that has just sent."""
        self.left -= 1
        if self.left == 0:
            suspended = self.mode == "intermission" and self.transmitter and self.passive
            self.mode, self.left = ("suspend", 8) if suspended else ("idle", 0)


def run(nodes: list[Node], bits: int, disturbed: dict[int, int]) -> None:
    """Runs a bus for so many bits; disturbed: by number of the attempt, the index of the inverted bit."""
    attempt, start = -1, 0
    for t in range(bits):
        if not any(node.frame for node in nodes) and all(node.mode in ("idle", "off") for node in nodes):
            return
        sending = [node.sending for node in nodes if node.mode == "frame" and node.sending is not None]
        length = len(sending[0]) if sending else None
        began = not any(node.mode == "frame" for node in nodes)
        levels = [node.drive(length) for node in nodes]
        if began and any(node.mode == "frame" for node in nodes):
            attempt, start = attempt + 1, t
        level = min(levels)
        if disturbed.get(attempt) == t - start:
            level = 1 - level
        sending = [node.sending for node in nodes if node.mode == "frame" and node.sending is not None]
        length = len(sending[0]) if len({len(one) for one in sending}) == 1 else None
        for node in nodes:
            node.sample(t, level, length)
