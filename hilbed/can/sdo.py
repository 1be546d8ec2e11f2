"""SDO client: reads and writes objects of a drive, expedited or in segments (CiA 301)."""

from __future__ import annotations

from collections.abc import Iterator
from struct import Struct, error
from typing import NoReturn

from hilbed.can import sdo_aborts
from hilbed.can.cob import SDO_ANSWER, SDO_REQUEST
from hilbed.can.codec import scalar
from hilbed.can.link import Link
from hilbed.clock import MILLISECOND
from hilbed.types import BusError, Frame, Nanos

_HEAD = Struct("<BHBI")  # command, index, sub-index, data or size or abort code
_LONGEST = 1 << 16  # bytes; no drive has a longer object, a node that sends on and on is stopped

DOWNLOAD, UPLOAD, ABORT = 0x20, 0x40, 0x80
EXPEDITED, SIZE_GIVEN, TOGGLE_BIT, LAST = 0x02, 0x01, 0x10, 0x01
_KIND = 0xE0  # the upper three bits name the command


def download_frame(node: int, index: int, sub: int, data: bytes) -> Frame:
    """Returns the expedited request that writes one to four bytes."""
    command = DOWNLOAD | (4 - len(data)) << 2 | EXPEDITED | SIZE_GIVEN
    return Frame(SDO_REQUEST + node, _HEAD.pack(command, index, sub, 0)[:4] + data.ljust(4, b"\0"))


class SdoError(BusError):
    """A transfer that failed; `code`: of the abort, by the drive or by the controller."""

    def __init__(self, text: str, code: int) -> None:
        super().__init__(text)
        self.code = code


class SdoClient:
    """The controller's side of one drive's SDO server; every failure is a BusError that names all of it.

    asked: how many requests were sent that are answered by one frame each.
    """

    def __init__(self, link: Link, name: str, node: int, timeout: Nanos = 100 * MILLISECOND) -> None:
        self.asked = 0
        self._link = link
        self._who = f"drive {name} (node {node})"
        self._node = node
        self._timeout = timeout

    def read(self, index: int, sub: int, data_type: str) -> int:
        """Reads an object of an integer type."""
        data = self.upload(index, sub)
        try:
            (value,) = scalar(data_type).unpack(data)
        except error:
            raise BusError(
                f"{self._who}: {index:04X}:{sub:02X} has {len(data)} bytes, not a {data_type}"
            ) from None
        return int(value)

    def write(self, index: int, sub: int, data_type: str, value: float) -> None:
        """Writes an object of a numeric type, rounded where it is an integer."""
        try:
            data = scalar(data_type).pack(value if data_type[0] == "f" else round(value))
        except (error, OverflowError):
            raise BusError(
                f"{self._who}: {value:g} does not fit {index:04X}:{sub:02X}, a {data_type}"
            ) from None
        self.download(index, sub, data)

    def upload(self, index: int, sub: int) -> bytes:
        """Reads an object's bytes."""
        head = self._ask(_HEAD.pack(UPLOAD, index, sub, 0), UPLOAD, index, sub)
        command, size = head[0], int.from_bytes(head[4:], "little")
        if command & EXPEDITED:
            return head[4 : 8 - (command >> 2 & 3)] if command & SIZE_GIVEN else head[4:]
        data = b"".join(self._segments(index, sub))
        if command & SIZE_GIVEN and len(data) != size:
            raise BusError(f"{self._what(index, sub)} sent {len(data)} bytes after announcing {size}")
        return data

    def download(self, index: int, sub: int, data: bytes) -> None:
        """Writes an object's bytes, in one frame where they fit."""
        if 0 < len(data) <= 4:
            self._ask(download_frame(self._node, index, sub, data).data, 0x60, index, sub)
            return
        self._ask(_HEAD.pack(DOWNLOAD | SIZE_GIVEN, index, sub, len(data)), 0x60, index, sub)
        toggle = 0
        for at in range(0, max(len(data), 1), 7):
            part = data[at : at + 7]
            last = LAST if at + 7 >= len(data) else 0
            command = toggle | (7 - len(part)) << 1 | last
            answer = self._exchange(bytes((command,)) + part.ljust(7, b"\0"), 0x20, index, sub)
            self._check_toggle(answer[0], toggle, index, sub)
            toggle ^= TOGGLE_BIT

    def _segments(self, index: int, sub: int) -> Iterator[bytes]:
        toggle, total = 0, 0
        while True:
            answer = self._exchange(bytes((0x60 | toggle,)) + bytes(7), 0x00, index, sub)
            self._check_toggle(answer[0], toggle, index, sub)
            part = answer[1 : 8 - (answer[0] >> 1 & 7)]
            total += len(part)
            if total > _LONGEST:
                self._give_up(sdo_aborts.OUT_OF_MEMORY, index, sub)
            yield part
            if answer[0] & LAST:
                return
            toggle ^= TOGGLE_BIT

    def _ask(self, request: bytes, kind: int, index: int, sub: int) -> bytes:
        """Opens a transfer; answers to other objects (late ones) are passed over."""
        return self._exchange(request, kind, index, sub, request[1:4])

    def _exchange(self, request: bytes, kind: int, index: int, sub: int, head: bytes = b"") -> bytes:
        """Sends a request; returns the eight bytes of an answer of that kind, whose object is `head`."""

        def accept(frame: Frame) -> bytes | None:
            identifier, data, extended, remote = frame
            if identifier != SDO_ANSWER + self._node or extended or remote or len(data) != 8:
                return None
            about = data[1:4]
            if data[0] == ABORT:
                return data if about == request_object else None
            return data if not head or about == head else None

        request_object = _HEAD.pack(0, index, sub, 0)[1:4]
        self._link.forget()
        self.asked += 1
        self._link.send(Frame(SDO_REQUEST + self._node, request))
        answer = self._link.answer(accept, self._timeout)
        if answer is None:
            self._give_up(sdo_aborts.TIMEOUT, index, sub)
        if answer[0] == ABORT:
            self._fail(int.from_bytes(answer[4:], "little"), "the drive says", index, sub)
        if answer[0] & _KIND != kind:
            self._give_up(sdo_aborts.COMMAND, index, sub)
        return answer

    def _check_toggle(self, command: int, toggle: int, index: int, sub: int) -> None:
        if command & TOGGLE_BIT != toggle:
            self._give_up(sdo_aborts.TOGGLE, index, sub)

    def _give_up(self, code: int, index: int, sub: int) -> NoReturn:
        """Tells the drive that the transfer is off, then the user."""
        self._link.send(Frame(SDO_REQUEST + self._node, _HEAD.pack(ABORT, index, sub, code)))
        self._fail(code, "the controller says", index, sub)

    def _fail(self, code: int, by: str, index: int, sub: int) -> NoReturn:
        what = self._what(index, sub)
        raise SdoError(f"{what} failed, {by}: {sdo_aborts.meaning(code)} (abort code {code:08X})", code)

    def _what(self, index: int, sub: int) -> str:
        return f"{self._who}: SDO transfer of {index:04X}:{sub:02X}"
