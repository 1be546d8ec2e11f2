"""An eye in a process of its own: it renders and detects while the physics goes on."""

from __future__ import annotations

import os
import pickle
import socket
from contextlib import suppress
from io import BufferedRWPair
from mmap import mmap
from subprocess import Popen, TimeoutExpired
from typing import TYPE_CHECKING, Any
from weakref import finalize

import numpy as np

from hilbed import offspring
from hilbed.cost import Cost, perf_counter
from hilbed.sensors.exposure import Exposure
from hilbed.sensors.eye import Glimpse, Setting, Ticket
from hilbed.sensors.parcel import made_findings, plain_exposure
from hilbed.types import HilbedError, Image

if TYPE_CHECKING:
    from hilbed.sensors.camera import CameraSpec

CHILD = "hilbed.sensors.remote_child"
PATIENCE = 60.0
_LAST_WORDS = 5.0  # s for a process whose end of the line is gone


class EyeLost(HilbedError):
    """The camera's own process could not be started, has ended or does not answer."""


class RemoteEye:
    """Asks a child process for frames: requests and findings over a socket, the image in shared memory.

    patience: s that the child may take to start or to make a frame. Raises ScenarioError where the renderer
    does not work, EyeLost (also from a look and its ticket) where the child fails. What the child says on
    standard output or error is lost; it ends with the socket, so also when this process is killed.
    """

    def __init__(self, spec: CameraSpec, setting: Setting, cost: Cost, patience: float = PATIENCE) -> None:
        self.beacons, self.cost = setting.beacons, cost
        self._ready = self._asked = False
        try:
            self._process, self._socket, memory = _start(spec.height * spec.width * 3)
        except OSError as error:
            raise EyeLost(f"the camera's own process cannot be started: {error.strerror}") from error
        self._socket.settimeout(patience)
        self._line = self._socket.makefile("rwb")
        self._socket.close()  # in name: it stays open as long as the file
        grace = _LAST_WORDS if spec.detector.kind == "foreign" else 0.0
        self._finalize = finalize(self, _end, self._process, self._line, grace)
        self._image: Image = np.frombuffer(memory, np.uint8).reshape(spec.height, spec.width, 3)
        self._send((spec, setting))
        if spec.renderer == "egl" or spec.detector.kind == "foreign":
            self._meet()  # one that does not work is an error of the scenario: found before it is run

    @property
    def pid(self) -> int:
        """The child's process number."""
        return self._process.pid

    def look(self, exposure: Exposure) -> Ticket:
        """Has a frame exposed."""
        if self._asked:
            raise RuntimeError("the frame before has not been taken yet")
        self._meet()
        start = perf_counter()
        self._send(plain_exposure(exposure))
        self._asked = True
        self.cost.vision += perf_counter() - start
        return self._take

    def close(self) -> None:
        """Ends the child."""
        self._finalize()

    def _meet(self) -> None:
        """Waits until the child has its renderer."""
        if not self._ready:
            self._wait()
            self._receive()
            self._ready = True

    def _take(self) -> Glimpse:
        self._wait()
        start = perf_counter()
        findings, trouble, said, render, vision = self._receive()
        glimpse = Glimpse(self._image.copy(), made_findings(findings), trouble, said)
        self._asked = False
        self.cost.add_beside("render", render)
        self.cost.add_beside("vision", vision)
        self.cost.vision += perf_counter() - start
        return glimpse

    def _send(self, message: object) -> None:
        try:
            pickle.dump(message, self._line)
            self._line.flush()
        except (OSError, ValueError) as error:
            raise self._lost() from error

    def _wait(self) -> None:
        try:
            self._line.peek(1)
        except TimeoutError as error:
            self.close()
            patience = self._socket.gettimeout()
            raise EyeLost(f"the camera's own process has not answered for {patience:g} s") from error
        except KeyboardInterrupt:
            self.close()  # nobody waits for a child that may hang, not even while the drives stop
            raise
        except (OSError, ValueError) as error:
            raise self._lost() from error

    def _receive(self) -> Any:
        try:
            message = pickle.load(self._line)
        except (EOFError, OSError, ValueError, pickle.UnpicklingError) as error:
            raise self._lost() from error
        if isinstance(message, HilbedError):
            self.close()
            raise message
        return message

    def _lost(self) -> EyeLost:
        try:
            status = self._process.wait(_LAST_WORDS)
        except TimeoutExpired:
            self.close()
            return EyeLost("the camera's own process does not answer any more")
        return EyeLost(f"the camera's own process has ended with {status}")


def _start(size: int) -> tuple[Popen[bytes], socket.socket, mmap]:
    """Returns a new child, this end of the line to it and the memory (bytes) that both see."""
    memory = os.memfd_create("hilbed-frame")
    ours, theirs = socket.socketpair()
    try:
        os.truncate(memory, size)
        shared = mmap(memory, 0)
        ends = theirs.fileno(), memory
        return offspring.start(CHILD, ends, keep=ends), ours, shared
    except OSError:
        ours.close()
        raise
    finally:
        theirs.close()
        os.close(memory)


def _end(child: Popen[bytes], line: BufferedRWPair, grace: float) -> None:
    """Ends a child in whatever state it is.

    grace: s that it has to end a child of its own, a foreign detector; else there is nothing to be put in
    order.
    """
    if grace:
        child.terminate()
        with suppress(TimeoutExpired):
            child.wait(grace)
    child.kill()
    child.wait()
    with suppress(OSError):  # a request that was never sent
        line.close()
