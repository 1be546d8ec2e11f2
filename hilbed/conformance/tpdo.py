"""One TPDO of the drive under test: switched, mapped, and in the end as it was."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress

from hilbed.can.objects import Entry
from hilbed.can.sdo import SdoError
from hilbed.conformance.subject import Subject

OFF, NO_REMOTE = 1 << 31, 1 << 30


class Tpdo:
    """A TPDO of the drive, by its name in the table; in the end it is given back all that it had."""

    def __init__(self, subject: Subject, name: str) -> None:
        self._subject = subject
        self.cob_id = subject.node.table.pdos[name].cob_id + subject.node.id
        number = int(name[-1]) - 1
        parameters, mapping = 0x1800 + number, 0x1A00 + number
        self._cob = Entry(index=parameters, sub=1, type="u32")
        self._kind = Entry(index=parameters, sub=2, type="u8")
        self._count = Entry(index=mapping, sub=0, type="u8")
        self._slots = [Entry(index=mapping, sub=sub, type="u32") for sub in range(1, 9)]
        self._was = [subject.read_entry(entry) for entry in (self._cob, self._kind, self._count)]
        self._mapped = [subject.read_entry(slot) for slot in self._slots[: self._was[2]]]
        subject.in_the_end(self._restore)

    def off(self) -> None:
        """Switches it off."""
        self._subject.put(self._cob, self.cob_id | NO_REMOTE | OFF)

    def on(self, kind: int = 1) -> None:
        """Switches it on, at every SYNC if not told otherwise."""
        self._subject.put(self._kind, kind)
        self._subject.put(self._cob, self.cob_id | NO_REMOTE)

    def map(self, mapped: Sequence[int]) -> None:
        """Writes its mapping, entries as index, sub-index and bits in one number."""
        self._subject.put(self._count, 0)
        for slot, entry in zip(self._slots, mapped, strict=False):
            self._subject.put(slot, entry)
        self._subject.put(self._count, len(mapped))

    def _restore(self) -> None:
        """Gives it back all that it had."""
        cob, kind, _ = self._was
        self._subject.put(self._cob, cob | OFF)
        self._subject.put(self._kind, kind)
        with suppress(SdoError):  # a drive whose PDOs cannot be remapped
            self.map(self._mapped)
        self._subject.put(self._cob, cob)
