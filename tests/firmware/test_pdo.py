"""PDOs: defaults, remapping by the canopen library, transmission types, timers, events."""

from __future__ import annotations

import struct

import canopen
import pytest

from firmware_sim import Frame
from tests.firmware.wire import NODE, enabled, operational, powered

T1, T2, T3, T4 = (base + NODE for base in (0x180, 0x280, 0x380, 0x480))


def test_the_library_reads_the_default_mapping() -> None:
    wire = powered()
    wire.node.pdo.read()
    for table, number, cob, kind, mapped in (
        (wire.node.rpdo, 1, 0x205, 1, [0x6040, 0x60FF]),
        (wire.node.tpdo, 1, 0x185, 1, [0x6041, 0x606C, 0x6077]),
        (wire.node.tpdo, 2, 0x285, 1, [0x6064, 0x6078]),
        (wire.node.tpdo, 3, 0x385, 255, [0x6061, 0x603F, 0x6079]),
    ):
        pdo = table[number]
        assert (pdo.enabled, pdo.cob_id, pdo.trans_type) == (True, cob, kind)
        assert [variable.index for variable in pdo.map] == mapped
    assert wire.node.tpdo[3].event_timer == 100
    assert not any(wire.node.rpdo[i].enabled for i in (2, 3, 4))
    assert not wire.node.tpdo[4].enabled


def test_sync_samples_both_cyclic_pdos() -> None:
    wire = operational()
    wire.run(20, counts_per_tick=-10)
    wire.current, wire.sent = -1680, []
    wire.run(1, counts_per_tick=-10)
    wire.send_sync()
    (first,), (second,) = wire.take(T1), wire.take(T2)
    status, velocity, torque = struct.unpack("<Hih", first)
    position, current = struct.unpack("<ih", second)
    assert status == 0x0250
    assert velocity == pytest.approx(-10_000, abs=50)
    assert torque == pytest.approx(-500, abs=1)
    assert (position, current) == (-200, -500)


def test_a_synchronous_command_waits_for_sync() -> None:
    wire = operational()
    wire.send_message(0x205, struct.pack("<Hi", 0x06, 0))
    assert wire.state() == "SWITCH ON DISABLED"
    wire.send_sync()
    assert wire.state() == "READY TO SWITCH ON"


def test_nothing_but_operational_moves_pdos() -> None:
    for nmt in ("PRE-OPERATIONAL", "STOPPED"):
        wire = operational()
        wire.node.nmt.state = nmt
        wire.sent = []
        wire.command(0x06)
        wire.run(300)
        assert wire.sent == []
        wire.node.nmt.state = "OPERATIONAL"
        wire.send_sync()
        assert wire.state() == "SWITCH ON DISABLED"


def test_a_command_waiting_for_sync_dies_with_operational() -> None:
    wire = operational()
    wire.send_message(0x205, struct.pack("<Hi", 0x06, 0))
    wire.node.nmt.state = "PRE-OPERATIONAL"
    wire.node.nmt.state = "OPERATIONAL"
    wire.send_sync()
    assert wire.state() == "SWITCH ON DISABLED"


def test_a_command_may_act_on_arrival() -> None:
    wire = powered()
    pdo = wire.node.rpdo[1]
    pdo.read()
    pdo.trans_type = 255
    pdo.save()
    wire.node.nmt.state = "OPERATIONAL"
    wire.send_message(0x205, struct.pack("<Hi", 0x06, 0))
    assert wire.state() == "READY TO SWITCH ON"


def test_remapping_by_the_library() -> None:
    wire = powered()
    tpdo, rpdo = wire.node.tpdo[4], wire.node.rpdo[2]
    tpdo.read()
    tpdo.clear()
    for index in (0x6061, 0x6064, 0x1001, 0x6041):
        tpdo.add_variable(index)
    tpdo.cob_id, tpdo.trans_type, tpdo.enabled = 0x3A0, 1, True
    tpdo.save()
    rpdo.read()
    rpdo.clear()
    rpdo.add_variable(0x60FF)
    rpdo.add_variable(0x6060)
    rpdo.cob_id, rpdo.trans_type, rpdo.enabled = 0x3A1, 255, True
    rpdo.save()
    wire.node.nmt.state = "OPERATIONAL"
    wire.counts = 77
    wire.run(50)
    wire.send_message(0x3A1, struct.pack("<ib", -99, 3))
    wire.send_sync()
    assert wire.take(0x3A0) == [struct.pack("<biBH", 3, 77, 0, 0x1250)]
    assert wire.node.sdo[0x60FF].raw == -99
    assert wire.node.tpdo[4][0x6064].raw == 77


def test_the_order_of_remapping_is_enforced() -> None:
    sdo = powered().node.sdo

    def refused(index: int, sub: int, data: bytes) -> int:
        with pytest.raises(canopen.SdoAbortedError) as error:
            sdo.download(index, sub, data)
        return int(error.value.code)

    def entry(index: int, bits: int) -> bytes:
        return struct.pack("<I", index << 16 | bits)

    assert refused(0x1A00, 0, b"\0") == 0x06010000  # the PDO is on
    assert refused(0x1800, 1, struct.pack("<I", 0x400001A0)) == 0x06090030  # other identifier while on
    assert refused(0x1800, 3, b"\x0a\0") == 0x06010000
    sdo.download(0x1800, 1, struct.pack("<I", 0xC0000185))
    assert refused(0x1A00, 1, entry(0x6064, 32)) == 0x06010000  # sub-index 0 is not zero
    sdo.download(0x1A00, 0, b"\0")
    assert refused(0x1A00, 1, entry(0x5FFE, 32)) == 0x06020000
    assert refused(0x1A00, 1, entry(0x6064, 16)) == 0x06040041  # not its length
    assert refused(0x1A00, 1, entry(0x6083, 32)) == 0x06040041  # never in a PDO
    assert refused(0x1A00, 1, struct.pack("<I", 0x2010_0220)) == 0x06040041  # tunables least of all
    for sub in (1, 2, 3):
        sdo.download(0x1A00, sub, entry(0x6064, 32))
    assert refused(0x1A00, 0, b"\x03") == 0x06040042  # 12 bytes
    assert refused(0x1A00, 0, b"\x09") == 0x06040042
    sdo.download(0x1A00, 3, bytes(4))
    assert refused(0x1A00, 0, b"\x03") == 0x06020000  # an entry is empty
    sdo.download(0x1A00, 0, b"\x02")
    sdo.download(0x1400, 1, struct.pack("<I", 0x80000205))
    sdo.download(0x1600, 0, b"\0")
    assert refused(0x1600, 1, entry(0x6041, 16)) == 0x06040041  # a statusword cannot be received


@pytest.mark.parametrize("every", [1, 2, 7, 240])
def test_every_so_many_syncs(every: int) -> None:
    wire = powered()
    wire.node.sdo[0x1800][2].raw = every
    wire.node.nmt.state = "OPERATIONAL"
    for _ in range(3 * every):
        wire.send_sync()
    assert len(wire.take(T1)) == 3


def test_acyclic_synchronous_follows_an_event() -> None:
    wire = powered()
    wire.node.sdo[0x1800][2].raw = 0
    wire.node.nmt.state = "OPERATIONAL"
    wire.send_sync()
    wire.send_sync()
    assert len(wire.take(T1)) == 1  # its first state
    wire.command(0x06)  # acts after this SYNC's sample
    assert wire.take(T1) == []
    wire.send_sync()
    wire.send_sync()
    assert [data[:2] for data in wire.take(T1)] == [struct.pack("<H", 0x0231)]


def test_the_event_timer() -> None:
    wire = operational()
    wire.run(1000)
    assert len(wire.take(T3)) == 10
    assert wire.take(T1) == []


def test_a_new_mode_or_error_is_told_at_once_and_only_once() -> None:
    wire = operational()
    wire.run(10)
    assert len(wire.take(T3)) == 1
    wire.node.sdo[0x6060].raw = 9
    wire.supply -= 1  # a measured value is no event
    wire.run(10)
    assert wire.take(T3) == [struct.pack("<bHI", 9, 0, 23_750)]


def test_events_are_held_back_by_the_inhibit_time() -> None:
    wire = powered()
    sdo = wire.node.sdo
    sdo[0x1802][1].raw = 0xC0000385
    sdo[0x1802][3].raw = 500  # 50 ms
    sdo[0x1802][5].raw = 0
    sdo[0x1802][1].raw = 0x40000385
    wire.node.nmt.state = "OPERATIONAL"
    wire.run(1)
    for mode in (9, 3, 9):
        sdo[0x6060].raw = mode
        wire.run(5)
    assert len(wire.take(T3)) == 1
    wire.run(34)
    assert wire.take(T3) == []
    wire.run(2)
    assert [data[0] for data in wire.take(T3)] == [9]


def test_a_remote_request_is_answered_only_if_allowed() -> None:
    wire = operational()
    wire.send_message(T1, b"", remote=True)
    assert wire.take(T1) == []
    wire.node.sdo[0x1800][1].raw = 0x80000185
    wire.node.sdo[0x1800][1].raw = 0x00000185
    wire.send_message(T1, b"", remote=True)
    assert len(wire.take(T1)) == 1


def test_too_short_is_told_once_and_too_long_is_cut() -> None:
    wire = operational()
    for length in (0, 5, 5):
        wire.send_message(0x205, bytes(length))
        wire.run(1)
    assert wire.drive.malformed == 3
    assert [e.code for e in wire.node.emcy.log] == [0x8210]
    wire.send_message(0x205, struct.pack("<Hi", 0x06, 7) + b"\xff\xff")
    wire.send_sync()
    wire.run(1)
    assert wire.state() == "READY TO SWITCH ON"
    assert [e.code for e in wire.node.emcy.log] == [0x8210, 0]


def test_a_value_that_its_object_refuses_drops_the_whole_pdo() -> None:
    wire = powered()
    rpdo = wire.node.rpdo[2]
    rpdo.read()
    rpdo.add_variable(0x6060)
    rpdo.add_variable(0x60FF)
    rpdo.enabled = True
    rpdo.save()
    wire.node.nmt.state = "OPERATIONAL"
    wire.send_message(rpdo.cob_id, struct.pack("<bi", 77, 1000))
    assert (wire.node.sdo[0x6060].raw, wire.node.sdo[0x60FF].raw) == (0, 0)
    wire.send_message(rpdo.cob_id, struct.pack("<bi", 9, 1000))
    assert (wire.node.sdo[0x6061].raw, wire.node.sdo[0x60FF].raw) == (9, 1000)


def test_sync_window_and_sync_identifier() -> None:
    wire = operational()
    wire.node.sdo[0x1007].raw = 2000  # us
    wire.send_sync()
    wire.t += 2_000_001
    wire.command(0x06)
    assert wire.state() == "SWITCH ON DISABLED"
    wire.command(0x06)
    assert wire.state() == "READY TO SWITCH ON"
    wire.node.sdo[0x1005].raw = 0x90
    wire.sent = []
    wire.send_sync()
    assert wire.sent == []
    wire.send_message(0x90, b"\x07")  # with a counter
    assert len(wire.sent) == 2


def test_other_frames_with_an_identifier_of_ours_in_29_bits() -> None:
    wire = enabled()
    wire.sent = []
    wire.drive.on_frame(wire.t, Frame(0x80, b"", extended=True))
    assert not wire.drive.outbox
