"""An independent master, the canopen library, leads `hilbed drive` by the EDS that we ship."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from queue import SimpleQueue
from time import monotonic, sleep
from typing import Any

import canopen
import pytest
from canopen.profiles.p402 import BaseNode402

import firmware_sim
from tests.hil.processes import VCAN, drive, on_the_bus

NODE, MASTER = 5, 127
EDS = Path(firmware_sim.__file__).with_name("hilbed402.eds")
TURN = 66_000  # counts
TARGET, ACTUAL = "Target velocity in counts/s", "Velocity actual in counts/s"
POSITION, LINK = "Position actual in counts", "DC link voltage in mV"
PATIENCE = 5.0
BOOT_UP, PRE_OPERATIONAL, OPERATIONAL, STOPPED = 0, 127, 5, 4


class Master:
    """The library's network and node, and the NMT states that it has heard."""

    def __init__(self, network: canopen.Network) -> None:
        self.network = network
        self.node = BaseNode402(NODE, str(EDS))  # type: ignore[no-untyped-call]
        network.add_node(self.node)
        self.ends = ExitStack()
        self.ends.callback(network.__delitem__, NODE)
        self.heard: SimpleQueue[int] = SimpleQueue()
        self.node.nmt.add_heartbeat_callback(self.heard.put)

    def await_state(self, state: int) -> None:
        """Waits for a heartbeat with this state; the boot-up message is one with 0."""
        while self.heard.get(timeout=PATIENCE) != state:
            pass

    def heartbeat(self) -> None:
        """Sends one of the master's own."""
        self.network.send_message(0x700 + MASTER, bytes([OPERATIONAL]))

    def enable(self) -> None:
        """Leads the drive to `operation enabled` in profiled velocity, all by PDO, with SYNC at 100 Hz."""
        node = self.node
        node.setup_402_state_machine()  # type: ignore[no-untyped-call]
        node.nmt.state = "OPERATIONAL"
        self.network.sync.start(0.01)
        self.ends.callback(self.network.sync.stop)
        node.op_mode = "PROFILED VELOCITY"
        node.rpdo[1].start(0.01)
        self.ends.callback(node.rpdo[1].stop)
        node.tpdo[1].wait_for_reception(PATIENCE)
        node.state = "OPERATION ENABLED"

    def await_speed(self, low: float, high: float) -> None:
        """Waits for 4 s of TPDOs at most until the actual velocity stays within these (turns/s) for 0.1 s."""
        within = 0
        for _ in range(400):
            assert self.node.tpdo[1].wait_for_reception(PATIENCE) is not None
            speed = self.node.tpdo[1][ACTUAL].raw / TURN
            within = within + 1 if low <= speed <= high else 0
            if within == 10:
                return
        raise AssertionError(f"{speed} turns/s is not between {low} and {high}")

    def await_standstill(self) -> None:
        """Waits until the position stays for 50 ms: a test that failed may have left the motor turning."""
        before, now = None, self.node.sdo[POSITION].raw
        until = monotonic() + PATIENCE
        while before != now:
            assert monotonic() < until, "the motor does not come to rest"
            sleep(0.05)
            before, now = now, self.node.sdo[POSITION].raw


@pytest.fixture(scope="module")
def network() -> Iterator[canopen.Network]:
    with on_the_bus(drive(NODE)):
        network = canopen.Network()
        network.connect(interface="socketcan", channel=VCAN)
        yield network
        network.disconnect()


@pytest.fixture
def master(network: canopen.Network) -> Iterator[Master]:
    """A master of a drive that has just been reset and stands."""
    master = Master(network)
    with master.ends:
        master.node.nmt.send_command(0x81)
        master.await_state(BOOT_UP)
        master.await_standstill()
        yield master


def test_identity(master: Master) -> None:
    sdo = master.node.sdo
    assert sdo["Device type"].raw == 0x0002_0192
    described = sdo.od[0x1018]
    for sub in (1, 2, 3):
        assert sdo[0x1018][sub].raw == described[sub].default


def test_nmt_and_heartbeat(master: Master) -> None:
    node = master.node
    node.sdo["Heartbeat producer in ms"].raw = 20
    master.await_state(PRE_OPERATIONAL)
    for state, number in (("OPERATIONAL", OPERATIONAL), ("STOPPED", STOPPED), ("PRE-OPERATIONAL", 127)):
        node.nmt.state = state
        master.await_state(number)


@pytest.mark.parametrize(
    ("index", "value", "code"),
    [(0x5000, 0, 0x0602_0000), (0x6060, 99, 0x0609_0030), (0x1000, 1, 0x0601_0002)],
)
def test_what_cannot_be_written_is_aborted(master: Master, index: int, value: int, code: int) -> None:
    with pytest.raises(canopen.SdoAbortedError) as aborted:
        master.node.sdo.download(index, 0, value.to_bytes(1 if index == 0x6060 else 4, "little"))
    assert aborted.value.code == code


def test_boots_enables_drives_and_stops(master: Master) -> None:
    node = master.node
    master.enable()
    for target in (1.0, -0.5):
        node.rpdo[1][TARGET].raw = round(target * TURN)
        master.await_speed(target - 0.02, target + 0.02)
    assert node.sdo[ACTUAL].raw / TURN == pytest.approx(-0.5, abs=0.02)
    node.state = "QUICK STOP ACTIVE"
    master.await_speed(-0.01, 0.01)


def test_pdo_remapped_by_the_library(master: Master) -> None:
    node = master.node
    node.tpdo.read()  # type: ignore[no-untyped-call]
    mapping = node.tpdo[2]
    mapping.clear()
    for name in (LINK, POSITION):
        mapping.add_variable(name)
    mapping.trans_type, mapping.enabled = 1, True
    mapping.save()
    node.nmt.state = "OPERATIONAL"
    mapping.add_callback((received := SimpleQueue[Any]()).put)
    master.network.sync.transmit()
    received.get(timeout=PATIENCE)
    assert mapping[LINK].raw == node.sdo[LINK].raw
    assert mapping[POSITION].raw == node.sdo[POSITION].raw


def test_a_silent_master_is_a_fault_that_is_told_and_can_be_reset(master: Master) -> None:
    node = master.node
    node.sdo["Heartbeat consumer"][1].raw = MASTER << 16 | 100
    node.sdo["Abort connection option"].raw = 1  # a fault, not only a quick stop
    node.sdo["Error behaviour"][1].raw = 1  # stays operational, so that its PDOs tell of it
    master.enable()
    node.rpdo[1][TARGET].raw = TURN
    master.await_speed(0.98, 1.02)
    master.heartbeat()  # the first and only one
    emergency = node.emcy.wait(0x8130, timeout=PATIENCE)
    assert emergency is not None
    master.await_speed(-0.01, 0.01)
    node.tpdo[1].wait_for_reception(PATIENCE)
    assert node.state == "FAULT"
    assert node.sdo["Error history"][1].raw & 0xFFFF == 0x8130
    master.heartbeat()
    node.rpdo[1][TARGET].raw = 0
    node.reset_from_fault()  # type: ignore[no-untyped-call]
    assert node.state == "OPERATION ENABLED"
