"""Firmware that is not called by the bench: in a thread on python-can's virtual bus, or as a process."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import can

from firmware_sim.process import as_frame, as_message
from firmware_sim.terminal import Terminal
from tests.plant.hub import QUICK


@contextmanager
def threaded(channel: str, *numbers: int) -> Iterator[None]:
    """Runs nodes on a channel of the virtual bus, which does not leave the process."""
    ended = threading.Event()
    buses = [can.Bus(interface="virtual", channel=channel) for _ in numbers]

    def run(bus: can.BusABC, number: int) -> None:
        terminal = Terminal(number)
        while not ended.is_set():
            message = bus.recv(0.05)
            for frame in [] if message is None else terminal.receive(as_frame(message)):
                bus.send(as_message(frame))

    threads = [threading.Thread(target=run, args=pair) for pair in zip(buses, numbers, strict=True)]
    for thread in threads:
        thread.start()
    try:
        yield
    finally:
        ended.set()
        for thread, bus in zip(threads, buses, strict=True):
            thread.join()
            bus.shutdown()


@contextmanager
def process(node: int, interface: str, channel: str, *more: str) -> Iterator[subprocess.Popen[str]]:
    """Runs `python -m firmware_sim` from when it says that it is ready, and ends it."""
    command = [sys.executable, "-m", "firmware_sim", "--node", str(node), "-i", interface, "-c", channel]
    command += more
    running = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=os.environ | QUICK)
    assert running.stderr is not None
    try:
        line = running.stderr.readline()
        assert "ready" in line, line
        yield running
    finally:
        running.terminate()
        running.wait(10)
        running.stderr.close()
