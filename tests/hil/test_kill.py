"""`kill -9` of the controller: drives in other processes stop, by themselves and in time."""

from __future__ import annotations

import time
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest

from tests.hil.drives import Probe, radians, sdo_number
from tests.hil.processes import ON_VCAN, REALTIME, Process, drive, on_the_bus, running
from tests.hil.scenarios import short
from tests.hil.witness import Candump, Seen

LEFT, RIGHT, CONTROLLER = 1, 2, 127
CRUISE = 2.0  # rad/s at least
ALLOWED = 0.1  # s beside consumer time and ramp
STARVED = 0.05  # s; a drive is asked every 5 ms
TOO_LATE = 0.2  # s; a drive stops at a heartbeat that is 0.25 s late
SYNC_TIMEOUT, CONSUMER, DECELERATION, SPEED, THRESHOLD = 0x2002, 0x1016, 0x6085, 0x606C, 0x606F
REAL = ("--arm", "--record", "none", "--set", "nodes.left=real", "--set", "nodes.right=real")
LONG = ("--set", "real_speed_limit=0.3", "--set", "duration=120")


@pytest.fixture
def probe() -> Iterator[Probe]:
    probe = Probe()
    yield probe
    probe.close()


def test_drives_stop_when_the_controller_is_killed(candump: Candump, probe: Probe, tmp_path: Path) -> None:
    run = ("run", str(short(tmp_path)), *ON_VCAN, *REALTIME, *REAL, *LONG, "--out", str(tmp_path / "run"))
    with on_the_bus(drive(LEFT), drive(RIGHT)):
        with running("hilbed", *run) as controller:
            await_cruise(probe, controller, candump)
            for node in (LEFT, RIGHT):  # or the missing SYNC stops them before the missing heartbeat does
                probe.write_u16(node, SYNC_TIMEOUT, 0)
            controller.kill()
        watch(probe)
        consumer = (probe.read(LEFT, CONSUMER, 1) & 0xFFFF) / 1000
        deceleration = radians(probe.read(LEFT, DECELERATION))
        stands = radians(probe.read(LEFT, THRESHOLD))
    seen = candump.seen()
    alive = heartbeats(seen)[-1]
    for node in (LEFT, RIGHT):
        speeds = [(at - alive, speed) for at, speed in told(seen, node) if at > alive]
        speed = max(speed for _, speed in speeds)
        stopped = min(at for at, _ in speeds if all(abs(v) <= stands for later, v in speeds if later >= at))
        ramp = speed / deceleration
        print(f"node {node} from {speed:.2f} rad/s: standstill {1e3 * stopped:.0f} ms after the controller's "
              f"last heartbeat (consumer {1e3 * consumer:.0f} ms, ramp {1e3 * ramp:.0f} ms)")  # fmt: skip
        assert speed > CRUISE
        assert consumer < stopped
        if stopped >= consumer + ramp + ALLOWED:
            skip_if_starved([at for at, _ in speeds if at <= stopped])
        assert stopped < consumer + ramp + ALLOWED


def await_cruise(probe: Probe, controller: Process, candump: Candump) -> None:
    """Waits until the robot drives; a machine too busy for the controller's heartbeats says nothing."""
    try:
        probe.await_frame(0x180 + LEFT, CRUISE, controller)
    except AssertionError:
        beats = heartbeats(candump.seen())
        gap = max((later - earlier for earlier, later in pairwise(beats)), default=0.0)
        if gap > TOO_LATE:
            pytest.skip(f"this machine is too busy for real time: {gap:.2f} s between two heartbeats")
        raise


def heartbeats(seen: list[Seen]) -> list[float]:
    """Returns when the controller has said that it lives."""
    return [one.at for one in seen if one.frame.startswith(f"{0x700 + CONTROLLER:03X}#")]


def watch(probe: Probe) -> None:
    """Reads the drives' speeds, for candump, until they are zero or should have been for long."""
    for _ in range(200):
        left, right = probe.read(LEFT, SPEED), probe.read(RIGHT, SPEED)
        if left == right == 0:
            return
        time.sleep(0.005)  # leaves the drives alone


def told(seen: list[Seen], node: int) -> Iterator[tuple[float, float]]:
    """Yields when a drive has answered and with which speed (rad/s)."""
    for at, frame in seen:
        identifier, _, data = frame.partition("#")
        if identifier == f"{0x580 + node:03X}" and data[2:8] == "6C6000":
            yield at, radians(sdo_number(bytes.fromhex(data)))


def skip_if_starved(answers: list[float]) -> None:
    """A machine that keeps a drive from answering for longer than a few polls keeps it from stopping, too."""
    gap = max((later - earlier for earlier, later in pairwise(answers)), default=0.0)
    if gap > STARVED:
        pytest.skip(f"this machine is too busy for a drive in real time: {gap:.3f} s between two answers")
