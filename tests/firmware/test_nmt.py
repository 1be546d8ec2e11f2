"""Network management, heartbeats both ways, SYNC time-out: what a node does when it is told or left alone."""

from __future__ import annotations

from itertools import pairwise

import canopen
import pytest

from firmware_sim import Drive, Frame
from tests.firmware.wire import NODE, Wire, enabled, operational, powered

BEAT, EMCY, MASTER = 0x700 + NODE, 0x80 + NODE, 0x77F
SPEED = 50_000  # counts/s


def codes(wire: Wire) -> list[int]:
    return [error.code for error in wire.node.emcy.log]


def moving(**written: int) -> Wire:
    """Returns a drive that turns its wheel; `written`: objects ("x6007") and values."""
    wire = enabled()
    for name, value in written.items():
        wire.node.sdo[int(name[1:], 16)].raw = value
    wire.command(0x0F, SPEED)
    wire.run(20)
    assert wire.drive.speed_ref == pytest.approx(4.76, abs=0.01)
    return wire


def test_a_drive_without_power_is_deaf_and_mute() -> None:
    drive = Drive(NODE)
    for identifier in (0x000, 0x080, 0x600 + NODE, 0x200 + NODE):
        drive.on_frame(0, Frame(identifier, bytes(8)))
    assert not drive.outbox


def test_power_on_sends_boot_up_once() -> None:
    wire = powered()
    wire.run(100)
    assert [(f.id, f.data) for f in wire.sent] == [(BEAT, b"\0")]
    assert wire.node.nmt.state == "PRE-OPERATIONAL"


@pytest.mark.parametrize("node", [0, 128])
def test_a_node_number_that_is_none(node: int) -> None:
    with pytest.raises(ValueError, match="1 to 127"):
        Drive(node)


def test_broadcast_and_foreign_commands() -> None:
    wire = powered()
    wire.node.sdo[0x1017].raw = 10
    wire.run(1)
    wire.send_message(0, [1, NODE + 1])
    wire.run(10)
    wire.send_message(0, [1, 0])
    wire.run(10)
    wire.send_message(0, [99, 0])
    wire.send_message(0, [2])
    wire.send_message(0, b"")
    wire.run(10)
    assert wire.take(BEAT)[1:] == [b"\x7f", b"\x7f", b"\x05", b"\x05"]
    assert wire.drive.malformed == 2


def test_sdo_works_where_it_should() -> None:
    wire = powered()
    assert wire.node.sdo[0x1000].raw == 0x20192
    wire.node.nmt.state = "OPERATIONAL"
    assert wire.node.sdo[0x1000].raw == 0x20192
    wire.node.nmt.state = "STOPPED"
    wire.node.sdo.RESPONSE_TIMEOUT = 0.01
    with pytest.raises(canopen.SdoCommunicationError):
        wire.node.sdo[0x1000].raw  # noqa: B018
    wire.node.nmt.state = "PRE-OPERATIONAL"
    assert wire.node.sdo[0x1000].raw == 0x20192


def test_the_heartbeat_goes_on_in_every_state() -> None:
    wire = powered()
    wire.node.sdo[0x1017].raw = 50
    wire.run(1)
    seen = []
    for state in ("OPERATIONAL", "STOPPED", "PRE-OPERATIONAL"):
        wire.node.nmt.state = state
        wire.take(BEAT)
        wire.run(200)
        seen.append(wire.take(BEAT))
    assert seen == [[b"\x05"] * 4, [b"\x04"] * 4, [b"\x7f"] * 4]
    wire.node.sdo[0x1017].raw = 0
    wire.run(200)
    assert wire.take(BEAT) == []


def test_reset_node_forgets_everything() -> None:
    wire = moving()
    wire.node.sdo[0x1017].raw = 10
    wire.node.sdo[0x2010][2].raw = 0.3
    wire.sent = []
    wire.node.nmt.state = "RESET"
    assert wire.take(BEAT) == [b"\0"]
    assert not wire.drive.bridge_enabled
    wire.run(100)
    assert wire.sent == []
    assert wire.duty == 0
    assert wire.state() == "SWITCH ON DISABLED"
    assert wire.node.sdo[0x2010][2].raw == pytest.approx(0.11)
    assert wire.node.sdo[0x60FF].raw == 0


def test_reset_node_forgets_a_fault_and_all_tuning() -> None:
    wire = moving()
    wire.node.sdo[0x2013][2].raw = 1.0
    wire.command(0x18F, SPEED)  # halt, and the bit that resets faults stays up
    wire.current = 1500
    wire.run(1)
    assert wire.state() == "FAULT"
    wire.node.nmt.send_command(129)
    wire.run(1)
    assert wire.node.sdo[0x1001].raw == 0
    assert wire.state() == "SWITCH ON DISABLED"
    wire.node.nmt.state = "OPERATIONAL"
    wire.node.sdo[0x6060].raw = 9
    for word in (0x06, 0x07, 0x0F):
        wire.command(word, SPEED)
    wire.run(10)  # at 1.5 A, which trips nothing any more
    assert wire.drive.speed_ref > 4
    wire.current = 30_000
    wire.run(1)
    wire.command(0x80)
    assert wire.state() == "SWITCH ON DISABLED"


def test_reset_communication_keeps_the_application() -> None:
    wire = powered()
    wire.node.sdo[0x1017].raw = 10
    wire.node.sdo[0x6060].raw = 9
    wire.node.sdo[0x6040].raw = 0x06
    wire.run(1)
    wire.sent = []
    wire.node.nmt.state = "RESET COMMUNICATION"
    wire.run(100)
    assert [f.data for f in wire.sent] == [b"\0"]
    assert (wire.node.sdo[0x1017].raw, wire.node.sdo[0x6060].raw) == (0, 9)
    assert wire.state() == "READY TO SWITCH ON"


@pytest.mark.parametrize("command", ["STOPPED", "PRE-OPERATIONAL", "RESET COMMUNICATION"])
def test_taken_out_of_operation_the_wheel_stops(command: str) -> None:
    wire = moving()
    wire.node.nmt.state = command
    assert wire.drive.bridge_enabled
    wire.run(150)  # 4.76 rad/s at 50 rad/s²
    assert wire.drive.speed_ref == 0.0
    assert not wire.drive.bridge_enabled


def beat(wire: Wire) -> None:
    wire.send_message(MASTER, b"\x05")


def watched(**written: int) -> Wire:
    """Returns a moving drive that has heard its master's heartbeat and waits 50 ms for the next."""
    wire = moving(**written)
    wire.node.sdo[0x1016][1].raw = 0x7F_0032
    wire.run(200)
    assert codes(wire) == []  # not watched before its first heartbeat
    beat(wire)
    return wire


def test_regular_heartbeats_keep_it_going() -> None:
    wire = watched()
    for _ in range(10):
        wire.run(49)
        beat(wire)
    assert codes(wire) == []
    assert wire.drive.speed_ref > 4


def test_a_lost_heartbeat_is_a_quick_stop() -> None:
    wire = watched()
    wire.run(50)
    assert codes(wire) == []
    wire.run(2)
    assert codes(wire) == [0x8130]
    assert wire.state() == "QUICK STOP ACTIVE"
    assert wire.node.sdo[0x1001].raw == 0x11
    assert wire.node.sdo[0x603F].raw == 0x8130
    wire.command(0x0F, SPEED)  # PDOs are off: 1029 has sent the node to pre-operational
    wire.run(150)
    assert wire.state() == "SWITCH ON DISABLED"
    assert not wire.drive.bridge_enabled
    assert wire.node.sdo[0x1001].raw == 0x11  # at rest it is still lost
    beat(wire)
    wire.run(1)
    assert codes(wire) == [0x8130, 0]
    assert wire.node.sdo[0x1001].raw == 0


@pytest.mark.parametrize(
    ("option", "state"),
    [
        (0, "OPERATION ENABLED"),
        (1, "FAULT REACTION ACTIVE"),
        (2, "SWITCH ON DISABLED"),
        (3, "QUICK STOP ACTIVE"),
    ],
)
def test_what_6007_says(option: int, state: str) -> None:
    wire = watched(x6007=option)
    wire.run(53)
    assert wire.state() == state


@pytest.mark.parametrize(("option", "state"), [(0, b"\x7f"), (1, b"\x05"), (2, b"\x04")])
def test_what_1029_says(option: int, state: bytes) -> None:
    wire = watched()
    wire.node.sdo[0x1029][1].raw = option
    wire.node.sdo[0x1017].raw = 10
    wire.run(60)
    wire.take(BEAT)
    wire.run(10)
    assert wire.take(BEAT) == [state]
    assert codes(wire) == [0x8130]


def test_a_fault_by_heartbeat_outlives_its_return() -> None:
    wire = watched(x6007=1)
    wire.run(250)
    beat(wire)
    wire.run(1)
    assert wire.state() == "FAULT"
    assert wire.node.sdo[0x603F].raw == 0x8130


def test_sync_time_out() -> None:
    wire = moving(x2002=25)
    for _ in range(10):
        wire.send_sync()
        wire.run(20)
    assert codes(wire) == []
    wire.run(7)
    assert codes(wire) == [0x8100]
    assert wire.state() == "QUICK STOP ACTIVE"
    wire.run(150)
    assert not wire.drive.bridge_enabled
    wire.node.nmt.state = "OPERATIONAL"
    wire.send_sync()
    wire.run(1)
    assert codes(wire) == [0x8100, 0]


def test_without_the_time_out_a_lost_sync_is_nothing() -> None:
    wire = moving()
    wire.run(2000)
    assert codes(wire) == []
    assert wire.drive.speed_ref > 4


def test_time_may_start_before_zero() -> None:
    wire = Wire()
    wire.t = -600_000_000
    wire.run(1)
    wire.node.nmt.state = "OPERATIONAL"
    wire.send_message(0x205, b"")
    wire.run(200)
    assert len(wire.take(0x385)) == 2
    assert codes(wire) == [0x8210]


def test_error_history_and_emcy_inhibit_time() -> None:
    wire = operational()
    wire.node.sdo[0x1015].raw = 100  # 10 ms
    for _ in range(3):
        wire.send_message(0x205, b"")
        wire.run(1)
        wire.send_message(0x205, bytes(6))
        wire.run(1)
    wire.run(100)
    assert codes(wire) == [0x8210, 0] * 3
    stamps = [error.timestamp for error in wire.node.emcy.log]
    assert min(b - a for a, b in pairwise(stamps)) == pytest.approx(0.010)
    assert [wire.node.sdo[0x1003][i].raw for i in range(5)] == [3, 0x8210, 0x8210, 0x8210, 0]
    wire.node.sdo[0x1003][0].raw = 0
    assert [wire.node.sdo[0x1003][i].raw for i in range(3)] == [0, 0, 0]


def test_the_history_keeps_the_newest() -> None:
    wire = operational()
    for _ in range(20):
        wire.send_message(0x205, b"")
        wire.send_message(0x205, bytes(6))
    assert wire.node.sdo[0x1003][0].raw == 8


def test_emcy_can_be_moved_and_switched_off() -> None:
    wire = operational()
    wire.node.sdo[0x1014].raw = 0x99
    wire.send_message(0x205, b"")
    wire.run(1)
    assert wire.take(0x99) == [b"\x10\x82\x11" + bytes(5)]
    wire.node.sdo[0x1014].raw = 0x80000099
    wire.send_message(0x205, bytes(6))
    wire.run(1)
    assert wire.take(0x99) == []
    assert wire.take(EMCY) == []


def test_each_of_two_masters_has_to_be_alive() -> None:
    wire = watched()
    wire.node.sdo[0x1016][2].raw = 0x7E_0032
    wire.send_message(0x77E, b"\x05")
    wire.send_message(0x77E, b"")  # no heartbeat
    beat(wire)
    assert wire.drive.malformed == 1
    wire.run(60)
    beat(wire)  # of the first one alone
    wire.run(1)
    assert wire.node.sdo[0x1001].raw == 0x11
    wire.send_message(0x77E, b"\x05")
    wire.run(1)
    assert wire.node.sdo[0x1001].raw == 0
