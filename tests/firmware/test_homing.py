"""Homing by a switch, told by the canopen library, whose reading of the statusword is the oracle."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from canopen.profiles.p402 import Homing

from tests.firmware.motor import COUNTS, Wheel
from tests.firmware.test_modes import drive
from tests.firmware.wire import NODE, Wire, operational

HOMING, CSP = 6, 8
RADIAN = COUNTS / math.tau
READY, START, HALT = 0x0F, 0x10, 0x100
NEGATIVE, POSITIVE, HOME = 1, 2, 4
EDGE = 0.2  # rad
Switch = Callable[[float], bool]
POSITIVE_SIDE: Switch = lambda angle: angle >= EDGE  # noqa: E731
NEGATIVE_SIDE: Switch = lambda angle: angle < EDGE  # noqa: E731

# Method, input, switch, and on which side of its edge it is when it is found (CiA 402, figures of 17 to 22).
METHODS = [
    (17, NEGATIVE, NEGATIVE_SIDE, 1),
    (18, POSITIVE, POSITIVE_SIDE, -1),
    (19, HOME, POSITIVE_SIDE, -1),
    (20, HOME, POSITIVE_SIDE, 1),
    (21, HOME, NEGATIVE_SIDE, 1),
    (22, HOME, NEGATIVE_SIDE, -1),
]


class Homed(Wire):
    """A drive, its motor and a switch; a master that waits lets time pass."""

    def __init__(self, start: float, bit: int = HOME, switch: Switch = POSITIVE_SIDE) -> None:
        self.wheel = Wheel()
        self.wheel.angle = start
        self._bit, self._switch = bit, switch
        super().__init__()
        self.live(1)

    def live(self, milliseconds: int) -> None:
        for _ in range(milliseconds):
            self.drive.read(self._bit * self._switch(self.wheel.angle))
            drive(self, self.wheel, 1)

    def begin(self, method: int) -> None:
        """Starts a homing at 1 rad/s, over the edge at 0.1 rad/s."""
        self.node.nmt.state = "OPERATIONAL"
        sdo = self.node.sdo
        sdo[0x6098].raw, sdo[0x6060].raw = method, HOMING
        sdo[0x6099][1].raw, sdo[0x6099][2].raw = round(1.0 * RADIAN), round(0.1 * RADIAN)
        for word in (0x06, 0x07, READY):
            sdo[0x6040].raw = word
        assert self.status() == "INTERRUPTED"
        sdo[0x6040].raw = READY | START

    def status(self) -> str:
        word = self.node.sdo[0x6041].raw
        (found,) = [name for name, (mask, bits) in Homing.STATES.items() if word & mask == bits]
        return str(found)

    def position(self) -> float:
        return float(self.node.sdo[0x6064].raw) / RADIAN


@pytest.mark.parametrize("start", [-0.3, 0.5], ids=["below", "above"])
@pytest.mark.parametrize(("method", "bit", "switch", "_"), METHODS, ids=[str(m[0]) for m in METHODS])
def test_home_is_the_edge_of_the_switch(method: int, bit: int, switch: Switch, _: int, start: float) -> None:
    """Where the position is zero is where the switch changes its state, to the way of a tick."""
    if method in (17, 18):  # a limit switch has nothing behind it
        start = start if not switch(start) else EDGE + (0.02 if method == 18 else -0.02)
    wire = Homed(start, bit, switch)
    wire.begin(method)
    assert wire.status() == "IN PROGRESS"
    for _tick in range(40):
        wire.live(100)
        if wire.status() != "IN PROGRESS":
            break
    wire.live(200)
    assert wire.status() == "TARGET REACHED"
    assert wire.wheel.angle - wire.position() == pytest.approx(EDGE, abs=3e-4)
    assert abs(wire.wheel.speed) < 0.02


@pytest.mark.parametrize(("method", "bit", "switch", "side"), METHODS, ids=[str(m[0]) for m in METHODS])
@pytest.mark.parametrize("turned", [0.0, 0.4])
def test_it_ends_on_the_side_that_the_method_says(
    method: int, bit: int, switch: Switch, side: int, turned: float
) -> None:
    """The edge is passed in one direction, wherever the axis has begun: a switch's play does not matter."""
    wire = Homed(EDGE - side * 0.01 if method in (17, 18) else EDGE - 0.2 + turned, bit, switch)
    wire.begin(method)
    wire.live(3000)
    assert wire.status() == "TARGET REACHED"
    assert 0.0 < side * (wire.wheel.angle - EDGE) < 0.05


def test_an_offset_is_where_home_is() -> None:
    wire = Homed(-0.1)
    wire.node.sdo[0x607C].raw = round(EDGE * RADIAN)
    wire.begin(19)
    wire.live(2000)
    assert wire.position() == pytest.approx(wire.wheel.angle, abs=3e-4)
    wire.node.sdo[0x607F].raw = round(2.0 * RADIAN)
    wire.node.sdo[0x607A].raw = 0
    wire.node.sdo[0x6060].raw = CSP
    wire.live(1000)
    assert wire.wheel.angle == pytest.approx(0.0, abs=2e-3)


def test_speeds_and_acceleration_of_the_search() -> None:
    wire = Homed(-3.0)
    wire.node.sdo[0x609A].raw = round(2.0 * RADIAN)
    wire.begin(19)
    wire.live(250)
    assert wire.drive.speed_ref == pytest.approx(0.5, abs=0.01)
    wire.live(1000)
    assert wire.drive.speed_ref == pytest.approx(1.0, abs=1e-4)
    wire.node.sdo[0x607F].raw = round(0.3 * RADIAN)
    wire.live(100)
    assert wire.drive.speed_ref == pytest.approx(0.3, abs=1e-4)
    wire.node.sdo[0x607F].raw = round(1.0 * RADIAN)
    while wire.wheel.angle < EDGE:
        wire.live(1)
    wire.live(1100)
    assert wire.drive.speed_ref == pytest.approx(-0.1, abs=1e-4)


@pytest.mark.parametrize(("reaction", "powered"), [(2, True), (0, False)])
def test_a_switch_that_does_not_come_is_a_fault(reaction: int, powered: bool) -> None:
    wire = Homed(0.0, HOME, lambda _: False)
    wire.node.sdo[0x2015].raw = 500
    wire.node.sdo[0x605E].raw = reaction
    wire.begin(19)
    wire.live(495)
    assert (wire.status(), wire.state()) == ("IN PROGRESS", "OPERATION ENABLED")
    wire.live(10)
    assert wire.drive.bridge_enabled is powered
    assert wire.status() == "ERROR VELOCITY IS NOT ZERO"
    wire.live(1500)
    assert (wire.status(), wire.state()) == ("ERROR VELOCITY IS ZERO", "FAULT")
    assert wire.node.sdo[0x603F].raw == 0x8600
    assert wire.take(0x80 + NODE)[0][:3] == bytes((0x00, 0x86, 0x21))
    for word in (0x00, 0x80, 0x06, 0x07, READY):
        wire.node.sdo[0x6040].raw = word
    assert wire.status() == "ERROR VELOCITY IS ZERO"
    wire.node.sdo[0x6040].raw = READY | START
    assert wire.status() == "IN PROGRESS"


def test_without_a_time_out_it_goes_on() -> None:
    wire = Homed(0.0, HOME, lambda _: False)
    wire.node.sdo[0x2015].raw = 0
    wire.begin(19)
    wire.live(12_000)
    assert wire.status() == "IN PROGRESS"


@pytest.mark.parametrize("word", [READY, READY | START | HALT, 0x02], ids=["bit 4", "halt", "quick stop"])
def test_it_can_be_interrupted(word: int) -> None:
    wire = Homed(-1.0)
    wire.begin(19)
    wire.live(300)
    wire.node.sdo[0x6040].raw = word
    wire.live(500)
    assert wire.status() == "INTERRUPTED"
    assert abs(wire.wheel.speed) < 0.02
    assert wire.wheel.angle < EDGE
    for again in (0x00, 0x06, 0x07, READY, READY | START):
        wire.node.sdo[0x6040].raw = again
    wire.live(3000)
    assert wire.status() == "TARGET REACHED"


def test_the_modes_own_bits_mean_nothing_elsewhere() -> None:
    """Bit 4 in CSP, and before the axis is enabled, begins nothing."""
    wire = Homed(0.0)
    wire.node.nmt.state = "OPERATIONAL"
    wire.node.sdo[0x6098].raw, wire.node.sdo[0x6060].raw = 19, HOMING
    wire.node.sdo[0x6040].raw = 0x16
    assert wire.status() == "INTERRUPTED"
    wire.node.sdo[0x6060].raw = CSP
    for word in (0x06, 0x07, READY, READY | START):
        wire.node.sdo[0x6040].raw = word
    wire.live(300)
    assert wire.wheel.angle == pytest.approx(0.0, abs=1e-3)


def test_a_mirrored_axis_searches_in_the_direction_of_its_position() -> None:
    wire = Homed(0.0, HOME, lambda angle: -angle >= EDGE)
    wire.node.sdo[0x607E].raw = 0xC0
    wire.begin(19)
    wire.live(2000)
    assert wire.status() == "TARGET REACHED"
    assert -wire.wheel.angle - wire.position() == pytest.approx(EDGE, abs=3e-4)


def test_inputs_are_shown_and_outlive_a_reset() -> None:
    wire = operational()
    assert wire.node.sdo[0x60FD].raw == 0
    wire.drive.read(NEGATIVE | HOME)
    assert wire.node.sdo[0x60FD].raw == 5
    wire.node.nmt.state = "RESET"
    wire.run(1)
    assert wire.node.sdo[0x60FD].raw == 5


def test_the_library_homes_it() -> None:
    class Waiting(Homed):
        """Every frame of the master takes 20 ms."""

        def send_message(self, can_id: int, data: object, remote: bool = False) -> None:
            super().send_message(can_id, data, remote)
            self.live(20)

    wire = Waiting(-0.2)
    wire.node.nmt.state = "OPERATIONAL"
    wire.node.sdo[0x6098].raw = 19
    assert wire.node.homing(timeout=60)
    assert wire.node.is_homed()
    assert wire.wheel.angle - wire.position() == pytest.approx(EDGE, abs=3e-4)
