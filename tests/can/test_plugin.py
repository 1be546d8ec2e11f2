"""The python-can interface "hilbed", used as any python-can program would."""

from __future__ import annotations

from typing import Any

import can
import pytest

from hilbed.can import channels
from hilbed.can.frame_length import frame_bits
from hilbed.can.wire import Wire
from hilbed.types import BusError, Frame


def bus(channel: str = "bench", **options: Any) -> can.BusABC:
    return can.Bus(interface="hilbed", channel=channel, **options)


def test_a_frame_crosses_in_the_time_it_takes() -> None:
    with bus() as a, bus() as b:
        a.send(can.Message(arbitration_id=0x123, data=b"hello", is_extended_id=False))
        message = b.recv(1.0)
        assert message is not None
        assert (message.arbitration_id, bytes(message.data), message.is_extended_id) == (
            0x123,
            b"hello",
            False,
        )
        assert message.timestamp == pytest.approx(frame_bits(Frame(0x123, b"hello")) * 2e-6, abs=1e-12)
        assert message.channel == "bench"
        assert a.recv(0.1) is None


def test_extended_and_remote_frames_keep_their_kind() -> None:
    with bus() as a, bus() as b:
        sent = can.Message(arbitration_id=0x1ABCDEF0, is_remote_frame=True, dlc=5)
        a.send(sent)
        message = b.recv()
        assert message is not None
        assert message.equals(sent, timestamp_delta=None, check_channel=False, check_direction=False)


def test_a_timeout_passes_in_simulated_time_only() -> None:
    with bus() as a, bus() as b:
        assert b.recv(3600.0) is None
        a.send(can.Message(arbitration_id=1))
        message = b.recv(1.0)
        assert message is not None
        assert 3600.0 < message.timestamp < 3600.001


def test_recv_without_timeout_gives_up_where_nothing_can_come() -> None:
    with bus() as a:
        assert a.recv() is None


def test_a_short_timeout_does_not_wait_for_a_long_frame() -> None:
    with bus(bitrate=10_000) as a, bus() as b:
        a.send(can.Message(arbitration_id=1, data=bytes(8)))
        assert b.recv(0.001) is None
        assert b.recv(0.1) is not None


def test_filters_pass_over_other_frames() -> None:
    with bus() as a, bus(can_filters=[{"can_id": 0x20, "can_mask": 0x7F0, "extended": False}]) as b:
        for identifier in (0x10, 0x21, 0x30, 0x2F):
            a.send(can.Message(arbitration_id=identifier, is_extended_id=False))
        assert [message.arbitration_id for message in b] == [0x21, 0x2F]


def test_iteration_is_by_arbitration_and_ends() -> None:
    with bus() as a, bus() as b:
        for identifier in (3, 1, 2):
            a.send(can.Message(arbitration_id=identifier, is_extended_id=False))
        assert [message.arbitration_id for message in b] == [1, 2, 3]


def test_channels_are_apart() -> None:
    with bus("one") as a, bus("two") as b:
        a.send(can.Message(arbitration_id=1))
        assert b.recv(1.0) is None
        assert {"interface": "hilbed", "channel": "two"} in can.detect_available_configs("hilbed")
    assert channels.names() == []


def test_a_channel_ends_with_its_last_bus() -> None:
    first = bus()
    assert first.recv(5.0) is None
    first.shutdown()
    first.shutdown()
    with bus() as a, bus() as b:
        a.send(can.Message(arbitration_id=1))
        message = b.recv(1.0)
        assert message is not None
        assert message.timestamp < 1.0


def test_a_bus_that_is_shut_down_refuses() -> None:
    closed = bus()
    closed.shutdown()
    with pytest.raises(can.CanOperationError, match="shut down"):
        closed.send(can.Message(arbitration_id=1))
    with pytest.raises(can.CanOperationError, match="shut down"):
        closed.recv(0)


@pytest.mark.parametrize("options", [{"bitrate": 7}, {"bitrate": "fast"}, {"fd": True}])
def test_bad_options_are_errors_of_python_can(options: dict[str, Any]) -> None:
    with pytest.raises((can.CanInitializationError, ValueError)):
        bus(**options)
    assert channels.names() == []


def test_two_bit_rates_on_one_channel() -> None:
    with bus(bitrate=250_000), pytest.raises(can.CanInitializationError, match="250000 bit/s, not at 500000"):
        bus(bitrate=500_000)


def test_frames_of_other_kinds_are_refused() -> None:
    with bus() as a:
        for message in (can.Message(is_fd=True), can.Message(is_error_frame=True)):
            with pytest.raises(can.CanOperationError, match="classical"):
                a.send(message)


def test_a_bench_owns_the_time() -> None:
    wire = Wire(500_000)
    wire.advance(0)
    node = wire.attach("node")
    with channels.lend("bench", wire), bus() as guest:
        node.send(0, Frame(0x77, b"x"))
        assert guest.recv(10.0) is None
        assert guest.recv() is None
        wire.advance(1_000_000)
        message = guest.recv()
        assert message is not None
        assert message.arbitration_id == 0x77
        guest.send(can.Message(arbitration_id=0x5, is_extended_id=False))
        wire.advance(2_000_000)
        assert [received.frame.id for received in node.recv(2_000_000)] == [5]
    assert channels.names() == []


def test_a_channel_is_lent_once() -> None:
    with bus(), pytest.raises(BusError, match="in use"), channels.lend("bench", Wire(500_000)):
        pass
