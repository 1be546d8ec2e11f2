"""`kill -9` of the controller: drives in other processes stop, by themselves and in time."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.hil.drives import Tester, pdo_speed, radians, sdo_number
from tests.hil.processes import ON_VCAN, drive, end, on_the_bus, start
from tests.hil.scenarios import short
from tests.hil.witness import Candump, Seen

pytestmark = pytest.mark.hil

LEFT, RIGHT, CONTROLLER = 1, 2, 127
CRUISE = 3.0  # rad/s at least
STANDSTILL = 0.03  # rad/s
ALLOWED = 0.1  # s beside consumer time and ramp
SYNC_TIMEOUT = 0x2002
REAL = ("--realtime", "--arm", "--record", "none", "--set", "nodes.left=real", "--set", "nodes.right=real")
FAST = ("--set", "duration=120", "--set", "real_speed_limit=0.5", "--set", "reference.acceleration=2")


@pytest.fixture
def tester() -> Iterator[Tester]:
    tester = Tester()
    yield tester
    tester.close()


def test_drives_stop_when_the_controller_is_killed(candump: Candump, tester: Tester, tmp_path: Path) -> None:
    with on_the_bus(drive(LEFT), drive(RIGHT)):
        controller = start("hilbed", "run", str(short(tmp_path)), *ON_VCAN, *REAL, *FAST)
        try:
            for node in (LEFT, RIGHT):
                tester.await_speed(node, CRUISE)
            # The right drive is left with its heartbeat consumer alone: it does not miss the SYNC.
            tester.write_u16(RIGHT, SYNC_TIMEOUT, 0)
        finally:
            controller.kill()
            end(controller)
        consumer = (tester.read(RIGHT, 0x1016, 1) & 0xFFFF) / 1000
        deceleration = radians(tester.read(RIGHT, 0x6085))
        for _ in range(300):
            if max(abs(tester.read(node, 0x606C)) for node in (LEFT, RIGHT)) == 0:
                break
    seen = candump.seen()
    alive = max(one.at for one in seen if one.frame.startswith(f"{0x700 + CONTROLLER:03X}#"))
    for name, node in (("left", LEFT), ("right", RIGHT)):
        speed, stopped = standstill(seen, node)
        ramp = speed / deceleration
        after = stopped - alive
        print(f"{name}: {speed:.2f} rad/s, standstill {1e3 * after:.0f} ms after the last heartbeat "
              f"(consumer {1e3 * consumer:.0f} ms, ramp {1e3 * ramp:.0f} ms)")  # fmt: skip
        assert speed > CRUISE
        assert after < consumer + ramp + ALLOWED


def standstill(seen: list[Seen], node: int) -> tuple[float, float]:
    """Returns the last speed that a PDO told of (rad/s) and when the drive said that it stood for good."""
    speed = 0.0
    stopped: float | None = None
    for at, frame in seen:
        identifier, _, data = frame.partition("#")
        if identifier == f"{0x180 + node:03X}":
            speed = pdo_speed(bytes.fromhex(data))
        elif identifier == f"{0x580 + node:03X}" and data[2:8] == "6C6000":
            turning = abs(radians(sdo_number(bytes.fromhex(data)))) > STANDSTILL
            stopped = None if turning else stopped or at
    assert stopped is not None, "it does not stop"
    return speed, stopped
