"""SDO server (CiA 301): expedited and segmented transfers, one at a time, no blocks."""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Final

from firmware_sim.abort import Abort, AbortCode
from firmware_sim.dictionary import ObjectDictionary
from firmware_sim.watchdog import NEVER

TIMEOUT_NS: Final = 1_000_000_000
_HEAD = struct.Struct("<BHB")
_TOGGLE = 0x10


class _Transfer:
    """A segmented transfer under way; `data` is what is still to be sent, or what has come so far."""

    __slots__ = ("data", "index", "most", "size", "sub", "toggle", "upload")

    def __init__(self, index: int, sub: int, upload: bool, data: bytes = b"") -> None:
        self.index = index
        self.sub = sub
        self.upload = upload
        self.data = data
        self.toggle = 0
        self.most = 0  # bytes the entry can hold
        self.size: int | None = None  # bytes the client announced


class SdoServer:
    """Answers requests; `written` is told the index after every value that was stored.

    due: when the transfer under way is given up (ns).
    """

    __slots__ = ("_dictionary", "_services", "_transfer", "_written", "due")

    def __init__(self, dictionary: ObjectDictionary, written: Callable[[int], None]) -> None:
        self._dictionary = dictionary
        self._written = written
        self._transfer: _Transfer | None = None
        self._services = (self._download_segment, self._download, self._upload, self._upload_segment)
        self.due = NEVER

    def request(self, t: int, data: bytes) -> bytes | None:
        """Returns the eight bytes that answer eight bytes; None after the client's abort."""
        service = data[0] >> 5
        if service == 4:
            self._end()
            return None
        try:
            if service > 3:
                raise Abort(AbortCode.COMMAND)
            answer = self._services[service](data)
        except Abort as abort:
            return self._abort(abort.code, data)
        self.due = NEVER if self._transfer is None else t + TIMEOUT_NS
        return answer.ljust(8, b"\0")

    def poll(self, t: int) -> bytes | None:
        """Gives up a transfer whose client has fallen silent; returns the abort to send."""
        return self._abort(AbortCode.TIMEOUT, b"") if t >= self.due else None

    def _end(self) -> None:
        self._transfer = None
        self.due = NEVER

    def _abort(self, code: AbortCode, request: bytes) -> bytes:
        transfer = self._transfer
        self._end()
        index, sub = 0, 0
        if request and request[0] >> 5 not in (0, 3):
            _, index, sub = _HEAD.unpack_from(request)
        elif transfer is not None:
            index, sub = transfer.index, transfer.sub
        return struct.pack("<BHBI", 0x80, index, sub, code)

    def _store(self, index: int, sub: int, data: bytes) -> None:
        self._dictionary.write(index, sub, data)
        self._written(index)

    def _download(self, request: bytes) -> bytes:
        command, index, sub = _HEAD.unpack_from(request)
        self._transfer = None
        entry = self._dictionary.writable(index, sub)
        if command & 2:
            # A client that does not tell the size means the object's own.
            size = 4 - (command >> 2 & 3) if command & 1 else min(4, entry.type.size)
            self._store(index, sub, request[4 : 4 + size])
        else:
            transfer = _Transfer(index, sub, upload=False)
            transfer.most = entry.type.size
            if command & 1:
                transfer.size = struct.unpack_from("<I", request, 4)[0]
                if transfer.size > transfer.most:
                    raise Abort(AbortCode.TOO_LONG)
            self._transfer = transfer
        return _HEAD.pack(0x60, index, sub)

    def _upload(self, request: bytes) -> bytes:
        _, index, sub = _HEAD.unpack_from(request)
        self._transfer = None
        data = self._dictionary.read(index, sub)
        if 0 < len(data) <= 4:
            return _HEAD.pack(0x43 | 4 - len(data) << 2, index, sub) + data
        self._transfer = _Transfer(index, sub, upload=True, data=data)
        return _HEAD.pack(0x41, index, sub) + len(data).to_bytes(4, "little")

    def _segment(self, command: int, upload: bool) -> _Transfer:
        transfer = self._transfer
        if transfer is None or transfer.upload is not upload:
            raise Abort(AbortCode.COMMAND)
        if command & _TOGGLE != transfer.toggle:
            raise Abort(AbortCode.TOGGLE)
        transfer.toggle ^= _TOGGLE
        return transfer

    def _download_segment(self, request: bytes) -> bytes:
        command = request[0]
        transfer = self._segment(command, upload=False)
        transfer.data += request[1 : 8 - (command >> 1 & 7)]
        if len(transfer.data) > transfer.most:
            raise Abort(AbortCode.TOO_LONG)
        if command & 1:
            if transfer.size not in (None, len(transfer.data)):
                raise Abort(AbortCode.LENGTH)
            self._store(transfer.index, transfer.sub, transfer.data)
            self._transfer = None
        return bytes((0x20 | command & _TOGGLE,))

    def _upload_segment(self, request: bytes) -> bytes:
        command = request[0]
        transfer = self._segment(command, upload=True)
        part, transfer.data = transfer.data[:7], transfer.data[7:]
        last = not transfer.data
        if last:
            self._transfer = None
        return bytes((command & _TOGGLE | 7 - len(part) << 1 | last,)) + part
