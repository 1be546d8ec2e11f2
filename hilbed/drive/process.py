"""The drive on the desk in real time: its bus, its clock, and the way it ends."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from time import monotonic_ns, sleep

from hilbed.can.hardware import Adapter
from hilbed.clock import MILLISECOND, SECOND
from hilbed.console import Stop, end_progress, progress, stop_on_signal
from hilbed.drive.desk import TICK, Build, Desk
from hilbed.drive.metronome import Metronome
from hilbed.drive.options import build_of
from hilbed.drive.probe import refuse_twin
from hilbed.types import Frame, Nanos

STATUS_PERIOD: Nanos = 200 * MILLISECOND
PATIENCE = 1.0
"""s that a slow adapter may take for a frame; a drive that answers late is of more use than one that ends."""


def main(options: argparse.Namespace) -> int:
    """Does `hilbed drive`; returns the exit status. Raises ScenarioError, BusError."""
    build = build_of(options)
    adapter = Adapter(options.interface, options.channel, options.bitrate, patience=PATIENCE)
    try:
        return drive(build, adapter, options.status)
    finally:
        adapter.close()


def drive(build: Build, adapter: Adapter, status: bool) -> int:
    """Runs a drive on an open bus until SIGINT or SIGTERM, which is its end and returns 0.

    status: a line about it in the terminal. Raises BusError where the node's number is taken or the bus lost.
    """
    name = f"drive node {build.node}"
    with stop_on_signal() as stop:
        refuse_twin(adapter, build.node)
        desk = Desk(build)
        metronome = Metronome(monotonic_ns(), TICK)
        _send(adapter, desk.tick(0, ()))
        metronome.ran()
        print(f"{name}: ready on {adapter.name}", file=sys.stderr, flush=True)
        show = _shower(name, desk, metronome) if status else _nothing
        try:
            _run(desk, adapter, metronome, stop, show)
        finally:
            end_progress()
    print(f"{name}: {stop.signal}, switched off{_account(metronome)}", file=sys.stderr)
    return 0


def _run(desk: Desk, adapter: Adapter, metronome: Metronome, stop: Stop, show: Callable[[], None]) -> None:
    while stop.signal is None:
        now = monotonic_ns()
        for _ in range(metronome.due(now)):
            # A drive looks at its mailboxes once a tick; between ticks nothing has to wake it.
            _send(adapter, desk.tick(metronome.ticks * TICK, adapter.poll()))
            metronome.ran()
            show()
        wait = metronome.deadline - monotonic_ns()
        if wait > 0:
            sleep(wait / SECOND)


def _send(adapter: Adapter, frames: list[Frame]) -> None:
    for frame in frames:
        adapter.send(frame)


def _nothing() -> None:
    """Shows nothing."""


def _shower(name: str, desk: Desk, metronome: Metronome) -> Callable[[], None]:
    every = STATUS_PERIOD // TICK

    def show() -> None:
        if metronome.ticks % every == 0:
            firmware, shaft = desk.firmware, desk.shaft
            progress(
                f"{name}: {firmware.state.name}, {shaft.speed:+.3f} of {firmware.speed_ref:+.3f} rad/s, "
                f"{desk.current:+.2f} A{_account(metronome)}"
            )

    return show


def _account(metronome: Metronome) -> str:
    late = f", latest tick {metronome.worst / MILLISECOND:.1f} ms"
    return late + (f", {metronome.dropped} ticks dropped" if metronome.dropped else "")
