"""`hilbed drive` as a process on a serial adapter, commanded by python-can alone."""

from __future__ import annotations

import os
import signal
import struct
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from math import tau

import can
import pytest

from tests.plant.hub import QUICK, Hub

COMMAND = [sys.executable, "-m", "hilbed", "drive"]


@contextmanager
def drive(path: str, *options: str) -> Iterator[subprocess.Popen[str]]:
    """Starts a drive and ends it, if the test has not."""
    command = [*COMMAND, "-i", "slcan", "-c", path, *options]
    running = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=os.environ | QUICK)
    try:
        yield running
    finally:
        running.kill()
        running.communicate()


def ready(running: subprocess.Popen[str]) -> str:
    assert running.stderr is not None
    line = running.stderr.readline()
    assert "ready" in line, line
    return line


class Master:
    """Just enough of a CANopen master, on one bus, to turn a drive."""

    def __init__(self, bus: can.BusABC, node: int) -> None:
        self.bus = bus
        self.node = node

    def send(self, identifier: int, data: bytes) -> None:
        self.bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))

    def hear(self, identifier: int) -> bytes:
        """Returns the next frame with this identifier; the test's own time-out ends a wait in vain."""
        while (message := self.bus.recv(20.0)) is not None:
            if message.arbitration_id == identifier:
                return bytes(message.data)
        raise AssertionError(f"{identifier:03X} does not come")

    def answer(self, service: int, index: int) -> bytes:
        """Returns the answer to a request, whatever others have asked before."""
        head = (service, index.to_bytes(2, "little"))
        while (answer := self.hear(0x580 + self.node))[0] >> 5 != head[0] or answer[1:3] != head[1]:
            assert answer[0] != 0x80, f"refused: {answer.hex()}"
        return answer

    def write(self, index: int, value: int, size: int) -> None:
        code = {1: 0x2F, 2: 0x2B, 4: 0x23}[size]
        data = struct.pack("<BHB", code, index, 0) + value.to_bytes(size, "little", signed=value < 0)
        self.send(0x600 + self.node, data.ljust(8, b"\0"))
        self.answer(3, index)

    def read(self, index: int) -> int:
        self.send(0x600 + self.node, struct.pack("<BHBI", 0x40, index, 0, 0))
        (value,) = struct.unpack("<i", self.answer(2, index)[4:])
        return int(value)


@contextmanager
def master(path: str, node: int) -> Iterator[Master]:
    with can.Bus(interface="slcan", channel=path, sleep_after_open=0) as bus:
        yield Master(bus, node)


def test_it_turns_as_it_is_told_until_it_is_ended() -> None:
    with Hub(2) as hub, master(hub.paths[0], 9) as desk, drive(hub.paths[1], "--node", "9") as running:
        assert ready(running) == f"drive node 9: ready on slcan {hub.paths[1]}\n"
        assert desk.hear(0x709) == b"\0"  # boot-up
        assert desk.read(0x1000) == 0x00020192
        desk.write(0x6060, 3, 1)
        for word in (0x06, 0x07, 0x0F):
            desk.write(0x6040, word, 2)
        target = round(-4.0 / tau * 66_000)
        desk.write(0x60FF, target, 4)
        while abs(desk.read(0x606C) - target) > 600:  # in its own time
            pass
        assert desk.read(0x6064) < 0
        running.send_signal(signal.SIGTERM)
        _, said = running.communicate(timeout=20)
        assert running.returncode == 0
        assert "SIGTERM, switched off" in said


def test_it_does_not_take_a_number_that_is_taken() -> None:
    with Hub(2) as hub, drive(hub.paths[0], "--node", "4") as first:
        ready(first)
        with drive(hub.paths[1], "--node", "4") as second:
            _, said = second.communicate(timeout=20)
            assert second.returncode == 7
            assert "there is a node 4 on the bus already" in said
        assert first.poll() is None
        first.send_signal(signal.SIGINT)
        first.communicate(timeout=20)
        assert first.returncode == 0


def test_a_bus_that_is_lost_ends_it() -> None:
    with Hub(1) as hub, drive(hub.paths[0], "--node", "1") as running:
        ready(running)
        hub.unplug(0)
        _, said = running.communicate(timeout=20)
        assert running.returncode == 7
        assert f"slcan {hub.paths[0]}: lost" in said


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--node", "0"], "--node 0: a node's number is 1 to 127"),
        (["--node", "1", "--gear", "-2"], "--gear -2: neither a positive ratio nor one of gp32c-33"),
        (["--node", "1", "--inertia", "0"], "--inertia 0: input should be greater than 0"),
        (["--node", "1", "--motor", "x", "--supply", "nan"], "--supply nan"),
        (["--node", "1", "--table", "nema17"], "no drive table 'nema17'"),
        (["--node", "1", "-i", "slcan", "-c", "/dev/no-such-adapter"], "/dev/no-such-adapter"),
        (["--node", "1", "-i", "nothing"], "unknown interface 'nothing'"),
        ([], "--node"),
    ],
)
def test_what_it_refuses(options: list[str], said: str) -> None:
    ended = subprocess.run([*COMMAND, *options], capture_output=True, text=True, timeout=60)
    assert ended.returncode == 4
    assert said in ended.stderr
    assert "Traceback" not in ended.stderr
