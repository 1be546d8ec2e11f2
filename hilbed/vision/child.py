"""The bench's end of the line to a process of its own: images in shared memory, JSON over a socket."""

from __future__ import annotations

import json
import os
import pickle
import signal
from contextlib import suppress
from select import select
from time import monotonic
from typing import Any
from weakref import finalize

import numpy as np

from hilbed.types import HilbedError, Image, ScenarioError
from hilbed.vision.spawn import end, start

LONGEST = 1 << 20
"""bytes of an answer: what is longer is garbage."""

_KEPT = 1 << 16  # bytes of what it prints between two answers
_LAST_WORDS = 0.5  # s for a traceback, or for what a process that has ended still had to say


class ChildLost(HilbedError):
    """The child has ended, or says what is no answer."""


class Child:
    """A process that may do anything: it is waited for only so long, and killed with all that it started.

    module: what runs there; size: bytes of the shared memory; first: what it is told first, pickled. Of what
    it prints, on standard output or error, the last 64 KiB are kept. It ends with this process, also when
    that one is killed; Ctrl-C does not hit it. Raises ScenarioError where no process can be started.
    """

    def __init__(self, module: str, size: int, first: object) -> None:
        try:
            self._process, self._socket, self._pipe, self._memory = start(module, size)
        except OSError as error:
            raise ScenarioError(f"{module}: a process cannot be started: {error.strerror}") from error
        self._finalize = finalize(self, end, self._process, self._socket, self._pipe)
        self._received = bytearray()
        self._said = bytearray()
        with suppress(ChildLost):  # the first answer will tell
            self.send(pickle.dumps(first))

    @property
    def pid(self) -> int:
        return self._process.pid

    def image(self, shape: tuple[int, ...]) -> Image:
        """Returns the shared memory as an image."""
        return np.frombuffer(self._memory, np.uint8, int(np.prod(shape))).reshape(shape)

    def send(self, message: bytes) -> None:
        """Sends a request; raises ChildLost."""
        try:
            self._socket.sendall(message)
        except OSError as error:
            raise self._lost() from error

    def answer(self, patience: float) -> dict[str, Any]:
        """Returns the answer to a request; raises TimeoutError after `patience` s, ChildLost."""
        until = monotonic() + patience
        while b"\n" not in self._received:
            self._listen(until)
        line, _, rest = self._received.partition(b"\n")
        self._received = bytearray(rest)
        try:
            answer = json.loads(line)
        except (ValueError, RecursionError):
            answer = None
        if not isinstance(answer, dict) or rest:
            raise ChildLost("its process wrote garbage on the bench's line")
        return answer

    def said(self) -> str:
        """Returns what it has printed since the last call, at most the last 64 KiB."""
        self._hear()
        text = self._said.decode(errors="replace")
        self._said.clear()
        return text

    def traceback(self) -> str:
        """Returns where it is at this moment, as `faulthandler` tells it; empty where it cannot."""
        before = len(self._said)
        with suppress(ProcessLookupError):
            self._process.send_signal(signal.SIGUSR1)
        if select([self._pipe], [], [], _LAST_WORDS)[0]:
            select([], [], [], 0.05)  # it writes a line at a time
            self._hear()
        told = self._said[before:].decode(errors="replace")
        del self._said[before:]
        return told[told.rfind("(most recent call first)") :]

    def close(self) -> None:
        """Ends the child in whatever state it is."""
        self._finalize()

    def _listen(self, until: float) -> None:
        """Waits for a piece of an answer; what is printed meanwhile is taken, so that no print blocks."""
        left = until - monotonic()
        both: list[int] = [self._socket.fileno(), self._pipe]
        ready = select(both, [], [], left)[0] if left > 0 else []
        if not ready:
            raise TimeoutError
        if self._pipe in ready:
            self._hear()
        if self._socket.fileno() in ready:
            with suppress(ConnectionError):
                piece = self._socket.recv(LONGEST)
                self._received += piece
                if not piece:
                    raise self._lost()
                if len(self._received) > LONGEST:
                    raise ChildLost("its process wrote garbage on the bench's line")

    def _hear(self) -> None:
        with suppress(BlockingIOError):
            while piece := os.read(self._pipe, _KEPT):
                self._said += piece
                del self._said[:-_KEPT]

    def _lost(self) -> ChildLost:
        with suppress(Exception):
            self._process.wait(_LAST_WORDS)
        status = self._process.poll()
        if status is None:
            return ChildLost("its process has closed the bench's line")
        if status < 0:
            return ChildLost(f"its process has died of {signal.Signals(-status).name}")
        return ChildLost(f"its process has ended with {status}")
