"""Programs on the bus as processes: ready before a test goes on, ended with it."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

VCAN = "vcan0"
ON_VCAN = ("-i", "socketcan", "-c", VCAN)

Process = subprocess.Popen[str]


def start(module: str, *arguments: str) -> Process:
    """Starts a Python program; its messages are readable at `stderr`."""
    command = [sys.executable, "-m", module, *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def await_line(process: Process, text: str) -> None:
    """Waits for a message with this text; fails with all that came instead."""
    assert process.stderr is not None
    seen = []
    for line in process.stderr:
        seen.append(line)
        if text in line:
            return
    raise AssertionError(f"{process.args!r} ended without saying {text!r}: {''.join(seen)}")


def end(process: Process) -> None:
    """Ends a process that still runs, and closes its pipes."""
    process.kill()
    process.communicate()


@contextmanager
def on_the_bus(*commands: tuple[str, ...]) -> Iterator[list[Process]]:
    """Starts Python programs that say `ready on` once they are on the bus, all at a time."""
    with ExitStack() as ends:
        processes = []
        for module, *arguments in commands:
            processes.append(start(module, *arguments, *ON_VCAN))
            ends.callback(end, processes[-1])
        for process in processes:
            await_line(process, "ready on")
        yield processes


def drive(node: int, *options: str) -> tuple[str, ...]:
    """The command of a whole simulated drive."""
    return ("hilbed", "drive", "--node", str(node), *options)


def firmware(node: int) -> tuple[str, ...]:
    """The command of one drive's firmware; its motor is simulated by the bench."""
    return ("firmware_sim", "--node", str(node))
