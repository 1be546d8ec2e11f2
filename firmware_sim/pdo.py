"""PDOs compiled from their objects: one `struct` and one look-up of keys each, made once per mapping."""

from __future__ import annotations

import struct
from collections.abc import Callable
from operator import itemgetter
from typing import Any, Final

from firmware_sim.dictionary import ENTRIES
from firmware_sim.entry import key
from firmware_sim.frame import Frame
from firmware_sim.objects.pdo import NO_REMOTE, OFF, RX_MAPPING, RX_PARAMETERS, TX_MAPPING, TX_PARAMETERS
from firmware_sim.watchdog import MILLISECOND, NEVER

Values = dict[int, Any]

# A frame past the __new__ of its class, which takes half of the time that a PDO would cost otherwise.
_new = tuple.__new__

SYNCHRONOUS: Final = 240  # transmission types up to this one act at a SYNC
# A change of one of these is an event that sends an asynchronous PDO; measured values are not.
_EVENTS = frozenset((key(0x1001), key(0x603F), key(0x6041), key(0x6061), key(0x60FD)))


def _mapped(values: Values, index: int) -> tuple[int, ...]:
    return tuple(values[key(index, i)] >> 8 for i in range(1, values[key(index, 0)] + 1))


def _layout(keys: tuple[int, ...]) -> struct.Struct:
    return struct.Struct("<" + "".join(ENTRIES[k].type.format for k in keys))


def _getter(keys: tuple[int, ...]) -> Callable[[Values], tuple[Any, ...]]:
    if len(keys) > 1:
        return itemgetter(*keys)
    return lambda values: tuple(values[k] for k in keys)


class Rpdo:
    """A received PDO: waits for SYNC, or acts at once, by its transmission type.

    size: bytes that a frame must have at least.
    """

    __slots__ = (
        "_checked",
        "_unpack",
        "_values",
        "cob",
        "controls",
        "keys",
        "pending",
        "size",
        "synchronous",
    )

    def __init__(self, values: Values, number: int) -> None:
        cob = values[key(RX_PARAMETERS + number, 1)]
        self.keys = _mapped(values, RX_MAPPING + number)
        self.cob: int | None = None if cob & OFF or not self.keys else cob & 0x7FF
        self.synchronous = values[key(RX_PARAMETERS + number, 2)] <= SYNCHRONOUS
        self.pending: bytes | None = None
        self._values = values
        layout = _layout(self.keys)
        self._unpack = layout.unpack_from
        self.size = layout.size
        self._checked = tuple((i, ENTRIES[k].choices) for i, k in enumerate(self.keys) if ENTRIES[k].choices)
        self.controls = key(0x6040) in self.keys

    def apply(self, data: bytes) -> bool:
        """Stores the mapped values and says so; a PDO with a value that its object refuses is dropped."""
        fields = self._unpack(data)
        for i, choices in self._checked:
            if fields[i] not in choices:
                return False
        values = self._values
        for k, value in zip(self.keys, fields):  # noqa: B905  (equally long by construction)
            values[k] = value
        return True


class Tpdo:
    """A transmitted PDO: counts SYNCs or runs its event and inhibit timers.

    due: when an asynchronous one is to be sent (ns).
    """

    __slots__ = (
        "_count",
        "_discrete",
        "_event",
        "_get",
        "_inhibit",
        "_kind",
        "_last",
        "_pack",
        "_quiet_until",
        "_values",
        "cob",
        "due",
        "remote",
    )

    def __init__(self, values: Values, number: int) -> None:
        parameters = TX_PARAMETERS + number
        cob = values[key(parameters, 1)]
        keys = _mapped(values, TX_MAPPING + number)
        self.cob: int | None = None if cob & OFF or not keys else cob & 0x7FF
        self.remote = not cob & NO_REMOTE
        self._values = values
        self._get = _getter(keys)
        self._pack = _layout(keys).pack
        self._kind: int = values[key(parameters, 2)]
        self._inhibit = values[key(parameters, 3)] * (MILLISECOND // 10)
        self._event = values[key(parameters, 5)] * MILLISECOND
        self._discrete = _getter(tuple(k for k in keys if k in _EVENTS))
        self.stop()

    @property
    def synchronous(self) -> bool:
        return self._kind <= SYNCHRONOUS

    def start(self, t: int) -> None:
        """The node became operational: an asynchronous PDO is sent at once, a synchronous one with SYNC."""
        self.stop()
        if not self.synchronous and self.cob is not None:
            self.due = t

    def stop(self) -> None:
        self.due = NEVER
        self._count = 0
        self._quiet_until = -NEVER
        self._last: tuple[Any, ...] | None = None

    def sync(self) -> Frame | None:
        """Returns the frame if this SYNC is one that the transmission type asks for."""
        kind = self._kind
        if kind == 1:
            return self.sample()
        if kind == 0:
            # Acyclic: with the SYNC that follows an event.
            return self.sample() if self._changed() else None
        self._count += 1
        if self._count < kind:
            return None
        self._count = 0
        return self.sample()

    def sample(self) -> Frame:
        return _new(Frame, (self.cob or 0, self._pack(*self._get(self._values)), False, False))

    def event(self, t: int) -> None:
        """Something discrete may have changed: schedules the frame if that is mapped here."""
        if not self.synchronous and self.cob is not None and self._discrete(self._values) != self._last:
            self.due = min(self.due, max(t, self._quiet_until))

    def poll(self, t: int) -> Frame:
        """Returns the frame of an asynchronous PDO that is due, and sets the timers."""
        self._last = self._discrete(self._values)
        self._quiet_until = t + self._inhibit
        self.due = max(t + self._event, self._quiet_until) if self._event else NEVER
        return self.sample()

    def _changed(self) -> bool:
        now = self._discrete(self._values)
        changed = now != self._last
        self._last = now
        return changed
