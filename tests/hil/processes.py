"""Programs on the bus as processes: ready before a test goes on, ended with it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress

VCAN = "vcan0"
ON_VCAN = ("-i", "socketcan", "-c", VCAN)
_PATIENT = ("realtime.tolerance=10", "realtime.give_up=60", "bus.silent_after=5", "period=0.05")
REALTIME = ("--realtime", *(word for value in _PATIENT for word in ("--set", value)))
"""A user-mode kernel has one processor for all processes: a late cycle still sends its commands."""

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


@contextmanager
def running(module: str, *arguments: str) -> Iterator[Process]:
    """Runs a Python program and ends it; a test that fails meanwhile shows what it has said."""
    process = start(module, *arguments)
    try:
        yield process
    except BaseException:
        process.kill()
        print(process.args, *process.communicate())
        raise
    finally:
        process.kill()
        process.communicate()


@contextmanager
def on_the_bus(*commands: tuple[str, ...]) -> Iterator[list[Process]]:
    """Runs Python programs that say `ready on` once they are on the bus; they start all at a time."""
    with ExitStack() as ends:
        processes = [ends.enter_context(running(*command, *ON_VCAN)) for command in commands]
        for process in processes:
            await_line(process, "ready on")
            _hurry(process)
        yield processes


def _hurry(process: Process) -> None:
    """Puts a process ahead of all others where that is allowed: a drive has a processor of its own."""
    with suppress(PermissionError):
        os.sched_setscheduler(process.pid, os.SCHED_FIFO, os.sched_param(1))


def drive(node: int, *options: str) -> tuple[str, ...]:
    """The command of a whole simulated drive."""
    return ("hilbed", "drive", "--node", str(node), *options)


def firmware(node: int) -> tuple[str, ...]:
    """The command of one drive's firmware; its motor is simulated by the bench."""
    return ("firmware_sim", "--node", str(node))
