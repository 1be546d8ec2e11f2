"""Random frames and pins for a drive: nonsense, nearly right, and now and then what a master would send."""

from __future__ import annotations

import random
from collections import deque
from typing import NamedTuple

from firmware_sim import Frame
from firmware_sim.dictionary import ENTRIES
from tests.firmware.wire import NODE, SUPPLY

SDO = 0x600 + NODE
SERVICES = (0x000, 0x080, 0x200 + NODE, 0x300 + NODE, SDO, 0x700 + NODE, 0x77F, 0x180 + NODE)
WORDS = (0x06, 0x07, 0x0F, 0x0F, 0x1F, 0x1F, 0x3F, 0x5F, 0x02, 0x00, 0x80, 0x10F)
HEADS = (0x23, 0x27, 0x2B, 0x2F, 0x22, 0x40, 0x40, 0x21, 0x20, 0x60, 0x70, 0x00, 0x01, 0x10, 0x80, 0xA4)
OBJECTS = tuple(sorted(ENTRIES))
BEHAVIOUR = tuple(k for k in OBJECTS if k >> 8 in (0x1029, 0x2013, 0x6007, 0x2015, *range(0x605A, 0x6080)))
MODES = (9, 9, 8, 6, 3, 1)
SIZED = {1: 0x2F, 2: 0x2B, 4: 0x23}


def sdo(head: int, where: int, data: bytes = b"") -> Frame:
    """Returns a request to the entry with this key."""
    return Frame(SDO, struct_head(head, where) + data.ljust(4, b"\0"))


def struct_head(head: int, where: int) -> bytes:
    return bytes((head,)) + (where >> 8).to_bytes(2, "little") + bytes((where & 0xFF,))


def bring_up(mode: int, method: int) -> list[Frame]:
    """Reset, operational, modes of operation and of homing, then into it; each controlword with a target."""
    return [
        Frame(0x000, bytes((129, NODE))),
        sdo(0x2F, 0x606000, bytes((mode,))),
        sdo(0x2F, 0x609800, bytes((method,))),
        Frame(0x000, bytes((1, NODE))),
        *(
            frame
            for word in (0x06, 0x07, 0x0F)
            for frame in (Frame(0x200 + NODE, bytes((word, 0, 0xD4, 0x30, 0, 0))), Frame(0x080))
        ),
    ]


class Pins(NamedTuple):
    """Counts, mA, quarters of a volt."""

    counts: int
    current: int
    supply: int


class Noise:
    """A stream of frames and pins from one seed."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self._script: deque[Frame] = deque()
        self._counts = self._swing = 0
        self._supply = SUPPLY

    def frame(self) -> Frame:
        """Returns the next frame: a third of them nonsense in every field."""
        if self._script:
            return self._script.popleft()
        source = self.random
        kind = source.random()
        if kind < 0.01:
            self._script.extend(bring_up(source.choice(MODES), source.choice((*range(17, 23), 37))))
        if kind < 0.3:
            return self._nonsense()
        if kind < 0.45:
            return Frame(source.choice(SERVICES), source.randbytes(source.choice((0, 1, 2, 6, 8))))
        if kind < 0.5:
            return Frame(0x000, bytes((source.choice((1, 1, 1, 2, 128, 129, 130)), NODE)))
        if kind < 0.65:
            word = source.choice(WORDS)
            return Frame(0x200 + NODE, word.to_bytes(2, "little") + source.randbytes(4))
        if kind < 0.8:
            return Frame(0x080)
        if kind < 0.9:
            return self._write()
        return sdo(source.choice(HEADS), source.choice(OBJECTS), source.randbytes(4))

    def _nonsense(self) -> Frame:
        source = self.random
        extended = source.random() < 0.5
        identifier = source.randrange(1 << 29 if extended else 1 << 11)
        return Frame(identifier, source.randbytes(source.randrange(9)), extended, source.random() < 0.2)

    def _write(self) -> Frame:
        """Returns an expedited download that fits an entry, most often with a small value."""
        source = self.random
        where = source.choice(OBJECTS if source.random() < 0.5 else BEHAVIOUR)
        size = ENTRIES[where].type.size
        value = source.randbytes(4) if source.random() < 0.3 else bytes((source.randrange(12), 0, 0, 0))
        return sdo(SIZED.get(size, 0x23), where, value)

    def inputs(self) -> int | None:
        """Returns the digital inputs where one of them has changed, which is rare."""
        return self.random.randrange(8) if self.random.random() < 0.005 else None

    def pins(self) -> Pins:
        """Returns the next pins: a wheel that turns anyhow, with a rare jump, sag or surge."""
        source = self.random
        jump = source.random() < 0.001
        if source.random() < 0.01:
            self._swing = source.choice((0, 0, 3, 100))
        self._counts += (
            source.randrange(-(2**31), 2**31) if jump else source.randint(-self._swing, self._swing)
        )
        counts = (self._counts + 2**31) % 2**32 - 2**31
        current = (
            source.randrange(-32768, 32768) if source.random() < 0.002 else source.randrange(-9000, 9000)
        )
        if source.random() < 0.05:
            self._supply = source.choice((0, 40, SUPPLY, SUPPLY, 255))
        return Pins(counts, current, self._supply)
