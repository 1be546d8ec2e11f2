"""Logs written by a process of their own: the bench does not wait for their formats, nor for the disk."""

from __future__ import annotations

import fcntl
import json
import os
import pickle
from collections import deque
from collections.abc import Sequence
from contextlib import suppress
from subprocess import PIPE, Popen
from typing import IO
from weakref import finalize

from hilbed import offspring
from hilbed.cost import Cost
from hilbed.record.disk import RecordError
from hilbed.record.logs import Plan
from hilbed.record.parcel import Piece, packed
from hilbed.record.row import Batch

CHILD = "hilbed.record.remote_child"
_AT_ONCE = 1  # batches under way: more than one would not fit into the pipe, and the bench would wait
_MOST = 20  # batches that are kept for a process that is behind; then the bench waits for it
_PIPE = 1 << 20  # bytes, the most that anybody may ask for


class RemoteLogs:
    """A sink that hands batches to a process which writes the logs of a plan; they are the same to the bit.

    What goes wrong there is told with the next batch, or on `close`, as RecordError; the logs that are left
    go on meanwhile. cost: where the seconds of that process go. Where this process is killed, the other one
    still writes all that it was given and ends the files properly. Raises RecordError if it cannot start.
    """

    def __init__(self, plan: Plan, cost: Cost) -> None:
        self._cost = cost
        try:
            self._process = offspring.start(CHILD, stdin=PIPE, stdout=PIPE)
        except OSError as error:
            raise RecordError(f"the process for the logs cannot be started: {error.strerror}") from error
        self._orders, self._answers = _pipes(self._process)
        self._finalize = finalize(self, _end, self._process)
        self._waiting: deque[Sequence[Piece]] = deque()
        self._under_way = 1  # what it has not answered yet: first of all, that it has started
        self._told = b""
        self._closed = False
        with suppress(OSError):  # it takes smaller bites then
            fcntl.fcntl(self._orders, fcntl.F_SETPIPE_SZ, _PIPE)
        os.set_blocking(self._answers.fileno(), False)
        with suppress(BrokenPipeError):  # the first batch will tell
            pickle.dump(plan, self._orders)
            self._orders.flush()

    @property
    def pid(self) -> int:
        """The number of the process that writes."""
        return self._process.pid

    def take(self, batch: Batch) -> None:
        """Hands a batch over; raises RecordError if one before it could not be written."""
        self._heed(self._answers.read())
        self._waiting.append(packed(batch))
        try:
            while self._waiting and (self._under_way < _AT_ONCE or len(self._waiting) > _MOST):
                self._send(self._waiting.popleft())
        except BrokenPipeError:
            self.close()

    def close(self) -> None:
        """Waits until everything is written; raises RecordError if it is not."""
        if self._closed:
            return
        self._closed = True
        with suppress(BrokenPipeError):
            while self._waiting:
                self._send(self._waiting.popleft())
        with suppress(BrokenPipeError):
            self._orders.close()
        os.set_blocking(self._answers.fileno(), True)
        answers = self._answers.read()
        status = self._process.wait()
        self._answers.close()
        self._heed(answers)
        if status:
            raise RecordError(f"the process for the logs has ended with {status}")

    def _send(self, pieces: Sequence[Piece]) -> None:
        """Writes a batch; waits where there is no room for it until the other process has read on."""
        for piece in pieces:
            self._orders.write(piece)
        self._orders.flush()
        self._under_way += 1

    def _heed(self, answers: bytes | None) -> None:
        """Takes the time that batches took, and raises RecordError if one of them could not be written."""
        *lines, self._told = (self._told + (answers or b"")).split(b"\n")
        troubles = []
        for line in lines:
            self._under_way -= 1
            spent, trouble = json.loads(line)
            self._cost.add_beside("record", spent)
            troubles += [trouble] if trouble else []
        if troubles:
            raise RecordError(troubles[0])


def _pipes(process: Popen[bytes]) -> tuple[IO[bytes], IO[bytes]]:
    """Returns the ends that were asked for: to write to a process, and to read from it."""
    assert process.stdin is not None
    assert process.stdout is not None
    return process.stdin, process.stdout


def _end(process: Popen[bytes]) -> None:
    """Lets a process that was forgotten end by itself: it has no more to come."""
    with suppress(OSError):
        for pipe in _pipes(process):
            pipe.close()
    process.wait()
