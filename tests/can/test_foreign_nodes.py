"""Drives on another bus that are not there, not what they should be, or two: each is told, none hangs.

The drives are firmware of ours at the far end of a gateway, each frame to or from them may be changed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from firmware_sim.drive import Drive
from hilbed.can.base import CanBase
from hilbed.can.drive_table import load_table
from hilbed.can.gateway import Gateway
from hilbed.can.master import Master
from hilbed.can.node import Node
from hilbed.can.specs import BusSpec
from hilbed.can.wire import Wire
from hilbed.clock import MILLISECOND
from hilbed.robots.diffdrive import DiffDrive, DiffDriveSpec
from hilbed.types import BusError, Command, Frame, Nanos
from tests.can.far_bus import FarBus

PERIOD = 10 * MILLISECOND
NODES = (Node("left", 1, load_table("hilbed402")), Node("right", 2, load_table("hilbed402")))
Change = Callable[[Frame], "Frame | None"]


def unchanged(frame: Frame) -> Frame:
    return frame


class FarDrives(FarBus):
    """Firmware that heeds what is sent and ticks once a poll, its shaft at rest; change: of what it says."""

    def __init__(self, numbers: Sequence[int], change: Change) -> None:
        super().__init__()
        self.drives = [Drive(number) for number in numbers]
        self.t: Nanos = 0
        self._change = change

    def send(self, frame: Frame) -> None:
        super().send(frame)
        for drive in self.drives:
            drive.on_frame(self.t, frame)

    def poll(self) -> list[Frame]:
        said = []
        for drive in self.drives:
            drive.tick(self.t, 0, 0, 96)
            said += [Frame(*frame) for frame in drive.outbox]
            drive.outbox.clear()
        changed = [self._change(frame) for frame in said]
        return [*(frame for frame in changed if frame is not None), *super().poll()]


class Bench:
    """A controller of two drives that are elsewhere."""

    def __init__(
        self, numbers: Sequence[int] = (1, 2), change: Change = unchanged, nodes: Sequence[Node] = NODES
    ) -> None:
        wire = Wire(500_000)
        self.far = FarDrives(numbers, change)
        self.gateway = Gateway(wire, self.far, wire, lockstep=False)
        self.port = wire.attach("controller")
        self.nodes = nodes
        for node in nodes:
            self.gateway.elsewhere(node)
        self.base = CanBase(DiffDrive(DiffDriveSpec()), self.port, nodes, BusSpec())

    def pump(self, t: Nanos) -> Nanos:
        self.far.t = t
        self.gateway.advance(t + MILLISECOND)
        return t + MILLISECOND

    def boot(self) -> None:
        Master(self.nodes, self.port, PERIOD).boot(self.pump, -1000 * MILLISECOND)

    def cycles(self, count: int) -> None:
        """Reads and writes in `count` cycles from t = 0 on."""
        t = 0
        for k in range(count):
            self.base.read(t)
            self.base.write(t, Command(0.1, 0.0))
            while t < (k + 1) * PERIOD:
                t = self.pump(t)


def refusal(bench: Bench) -> str:
    with pytest.raises(BusError) as error:
        bench.boot()
    return str(error.value)


def test_drives_elsewhere_boot_and_obey() -> None:
    bench = Bench()
    bench.boot()
    bench.cycles(20)
    assert all(drive.bridge_enabled and drive.speed_ref > 0.0 for drive in bench.far.drives)
    assert bench.base.late == {"left": 0, "right": 0}


def test_a_node_that_is_missing() -> None:
    assert "drive right (node 2): no boot-up message 702 within 300 ms" in refusal(Bench(numbers=[1]))


def test_a_node_that_is_another() -> None:
    table = NODES[1].table
    other = table.model_copy(update={"identity": table.identity.model_copy(update={"vendor": 0x22})})
    said = refusal(Bench(nodes=[NODES[0], Node("right", 2, other)]))
    assert said.startswith("drive right (node 2) is no hilbed402: 1018:01 is ")
    assert said.endswith("expected 0x22")


def test_an_object_that_a_node_refuses() -> None:
    said = refusal(Bench(nodes=[replace(NODES[0], settings={"current_limit": 1e6}), NODES[1]]))
    assert "drive left (node 1): SDO transfer of 2013:01 failed, the drive says" in said
    assert "abort code 06090031" in said


def test_a_node_that_falls_silent_while_it_is_configured() -> None:
    answers = 0

    def change(frame: Frame) -> Frame | None:
        nonlocal answers
        answers += frame.id == 0x581
        return None if answers > 5 else frame

    said = refusal(Bench(change=change))
    assert "drive left (node 1): SDO transfer of" in said
    assert "the controller says" in said


def test_two_drives_with_one_number_answer_twice() -> None:
    said = refusal(Bench(numbers=[1, 1, 2]))
    assert said.startswith("drive left (node 1): ")
    assert "two drives have the number 1" in said


def test_a_drive_that_starts_anew_while_it_is_configured() -> None:
    answers = 0

    def change(frame: Frame) -> Frame:
        nonlocal answers
        answers += frame.id == 0x581
        if answers == 20:
            bench.far.incoming.append(Frame(0x701, b"\0"))
        return frame

    bench = Bench(change=change)
    assert "drive left (node 1): started anew while it was configured" in refusal(bench)


@pytest.mark.parametrize(("size", "identifier"), [(4, 0x181), (0, 0x181), (5, 0x281)])
def test_a_pdo_that_is_shorter_than_its_mapping(size: int, identifier: int) -> None:
    def change(frame: Frame) -> Frame:
        return frame._replace(data=frame.data[:size]) if frame.id == identifier else frame

    bench = Bench(change=change)
    bench.boot()
    with pytest.raises(
        BusError, match=rf"drive left \(node 1\) has been sending PDO {identifier:03X} with {size} bytes"
    ):
        bench.cycles(30)


def test_a_pdo_that_is_short_once_is_passed_over() -> None:
    seen = 0

    def change(frame: Frame) -> Frame:
        nonlocal seen
        seen += frame.id == 0x181
        return frame._replace(data=b"") if frame.id == 0x181 and seen == 5 else frame

    bench = Bench(change=change)
    bench.boot()
    bench.cycles(30)
    assert bench.base.ears.ignored == 1


def test_a_node_that_is_lost_in_operation() -> None:
    bench = Bench()
    bench.boot()
    bench.cycles(5)
    bench.far.drives.pop()
    with pytest.raises(BusError, match=r"drive right \(node 2\) has been silent since"):
        bench.cycles(30)


KNOWN = (0x000, 0x080, 0x081, 0x181, 0x182, 0x201, 0x281, 0x381, 0x581, 0x601, 0x702, 0x77F)
STANDARD = st.sampled_from(KNOWN) | st.integers(0, 0x7FF)
FRAMES = st.builds(Frame, STANDARD, st.binary(max_size=8), st.just(False), st.booleans()) | st.builds(
    Frame, st.integers(0, 0x1FFFFFFF), st.binary(max_size=8), st.just(True)
)


@given(st.lists(st.tuples(st.integers(0, 29), FRAMES), max_size=30))
def test_frames_of_any_content_at_any_time_do_no_more_than_a_fault_could(
    frames: list[tuple[int, Frame]],
) -> None:
    """Whatever else is said on the bus, the bench goes on, or ends with a reason and its time."""
    bench = Bench()
    bench.boot()
    reason = ""
    try:
        for k in range(30):
            bench.far.incoming += [frame for at, frame in frames if at == k]
            bench.base.read(k * PERIOD)
            bench.base.write(k * PERIOD, Command(0.1, 0.0))
            for tick in range(10):
                bench.pump(k * PERIOD + tick * MILLISECOND)
    except BusError as error:
        reason = str(error)
    assert not reason or reason.startswith("t = ")
