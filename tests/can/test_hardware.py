"""The adapter on python-can's own drivers, on a serial line, and on drivers that misbehave."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from threading import Event

import can
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.can.hardware import MOST, Adapter
from hilbed.types import BusError, Frame, ScenarioError
from tests.can.odd_driver import odd
from tests.can.serial_line import line

FRAMES = st.builds(
    Frame, st.integers(0, 0x7FF), st.binary(max_size=8), st.just(False), st.booleans()
) | st.builds(Frame, st.integers(0, 0x1FFFFFFF), st.binary(max_size=8), st.just(True), st.booleans())


@pytest.fixture
def no_settings(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Neither python-can's variables nor its files are those of who runs the tests."""
    monkeypatch.setenv("HOME", str(tmp_path))
    for name in ("CAN_INTERFACE", "CAN_CHANNEL", "CAN_BITRATE", "CAN_CONFIG"):
        monkeypatch.delenv(name, raising=False)


@given(st.lists(FRAMES, max_size=5))
def test_frames_pass_over_python_cans_virtual_bus_both_ways(frames: list[Frame]) -> None:
    """python-can's other end is the oracle; data of a remote frame is only its length."""
    here, there = Adapter("virtual", "both ways", 500_000), can.Bus(interface="virtual", channel="both ways")
    for frame in frames:
        here.send(frame)
    heard = [there.recv(0) for _ in frames]
    assert there.recv(0) is None
    for frame, message in zip(frames, heard, strict=True):
        assert message is not None
        assert (message.arbitration_id, message.is_extended_id, message.is_remote_frame, message.dlc) == (
            frame.id, frame.extended, frame.remote, len(frame.data),
        )  # fmt: skip
        assert frame.remote or bytes(message.data) == frame.data
        there.send(message)
    nothing = [frame._replace(data=bytes(len(frame.data))) if frame.remote else frame for frame in frames]
    assert here.poll() == nothing
    assert (here.counts.sent, here.counts.received) == (len(frames), len(frames))
    here.close()
    there.shutdown()


def test_waiting_ends_with_the_first_frames_or_with_its_time() -> None:
    here, there = Adapter("virtual", "wait"), can.Bus(interface="virtual", channel="wait")
    assert here.wait(0.001) == []
    for k in range(3):
        there.send(can.Message(arbitration_id=k, is_extended_id=False))
    assert here.wait(10.0) == [Frame(0), Frame(1), Frame(2)]
    here.close()
    there.shutdown()


def test_one_poll_takes_so_many_and_the_next_one_the_others() -> None:
    here, there = Adapter("virtual", "many"), can.Bus(interface="virtual", channel="many")
    for k in range(MOST + 10):
        there.send(can.Message(arbitration_id=k, is_extended_id=False))
    assert [frame.id for frame in here.poll()] == list(range(MOST))
    assert [frame.id for frame in here.poll()] == list(range(MOST, MOST + 10))
    here.close()
    there.shutdown()


@pytest.mark.parametrize("threads", [True, False])
def test_what_is_no_frame_is_counted(threads: bool) -> None:
    with odd(threads) as (adapter, bus):
        for message in (
            can.Message(arbitration_id=0x004, is_error_frame=True, is_extended_id=False),
            can.Message(arbitration_id=1, is_fd=True, data=bytes(12)),
            can.Message(arbitration_id=0x800, is_extended_id=False),
            can.Message(arbitration_id=1 << 29),
            can.Message(arbitration_id=3, data=b"abc", dlc=5),
            can.Message(arbitration_id=4, is_extended_id=False, is_rx=False),
            ValueError("garbage on the line"),
            can.Message(arbitration_id=5, is_extended_id=False, data=b"x"),
        ):
            bus.incoming.put(message)
        frames: list[Frame] = []
        while not frames:
            frames = adapter.wait(1.0)
        assert frames == [Frame(5, b"x")]
        counts = adapter.counts
        assert (counts.received, counts.errors) == (1, 1)
        assert counts.malformed == 5


def test_an_adapter_that_goes_bus_off_is_lost() -> None:
    with odd(threads=False) as (adapter, bus):
        bus.incoming.put(can.Message(arbitration_id=0x040, is_error_frame=True, is_extended_id=False))
        with pytest.raises(BusError, match="odd x: lost while receiving: the adapter is bus-off"):
            adapter.poll()


@pytest.mark.parametrize("threads", [True, False])
def test_a_driver_that_fails_to_receive(threads: bool) -> None:
    with odd(threads) as (adapter, bus):
        bus.incoming.put(can.CanOperationError("Failed to receive: Network is down", 100))
        with pytest.raises(BusError, match="odd x: lost while receiving: Failed to receive: Network is down"):
            adapter.wait(10.0)


def test_a_driver_that_fails_to_send_and_drops_what_it_was_given() -> None:
    with odd(threads=False) as (adapter, bus):
        full = can.CanOperationError("Transmit buffer full")

        def refuse(_: can.Message) -> None:
            raise full

        bus.on_send = refuse
        with pytest.raises(BusError, match="odd x: lost while sending: Transmit buffer full"):
            adapter.send(Frame(1))
        bus.on_send = lambda _: None
        adapter.send(Frame(2))
        assert [message.arbitration_id for message in bus.sent] == [2]
        assert (adapter.counts.sent, adapter.counts.dropped) == (1, 1)


def test_a_driver_that_does_not_come_back_holds_nobody_up_and_gets_no_old_frames() -> None:
    """The driver keeps the first frame until it is let go; `send` returns all the same, then complains."""
    with odd() as (adapter, bus):
        free = Event()

        def keep(_: can.Message) -> None:
            free.wait()

        bus.on_send = keep
        adapter.send(Frame(0))
        assert bus.told.wait(10)
        with pytest.raises(BusError, match="frames wait for a driver that takes none"):
            send_on_and_on(adapter)
        adapter.purge()
        bus.on_send = lambda _: None
        free.set()
        assert adapter._sender is not None
        adapter._sender.flush(10.0)  # the driver may take a while to come back
        adapter.send(Frame(2))
        adapter.close(timeout=10.0)
        assert [message.arbitration_id for message in bus.sent] == [0, 2]


def test_a_driver_that_waits_in_vain_holds_nobody_up() -> None:
    with odd() as (adapter, _):
        assert [adapter.poll() for _ in range(1000)] == [[]] * 1000


def test_a_serial_adapter(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lines as the slcan protocol has them; acknowledgements and broken lines are no frames."""
    monkeypatch.setenv("CAN_CONFIG", json.dumps({"sleep_after_open": 0}))
    with line() as far:
        adapter = Adapter("slcan", far.path, 500_000)
        adapter.send(Frame(0x123, b"\x01\xfe"))
        adapter.send(Frame(0x1ABCDEF0, b"", extended=True))
        adapter.send(Frame(0x700, bytes(1), remote=True))
        assert far.read(3) == ["t123201FE", "T1ABCDEF00", "r7001"]
        far.write(b"z\r\rt7FF2abcd\rt12\rtXYZ0\rT00000001100\rr10")
        assert adapter.wait(10.0) == [Frame(0x7FF, b"\xab\xcd"), Frame(1, b"\0", extended=True)]
        far.write(b"02\r")
        assert adapter.wait(10.0) == [Frame(0x100, bytes(2), remote=True)]
        assert adapter.counts.malformed == 2
        far.unplug()
        with pytest.raises(BusError, match=f"slcan {far.path}: lost while receiving: Could not read"):
            adapter.poll()
        adapter.send(Frame(1))  # is on its way when the driver finds out
        assert adapter._sender is not None
        adapter._sender.flush(10.0)
        with pytest.raises(BusError, match=r"lost while sending: Could not write.*Input/output error"):
            adapter.send(Frame(2))
        adapter.close()


def send_on_and_on(adapter: Adapter) -> None:
    while True:
        adapter.send(Frame(1))


def refused(interface: str | None, channel: str | None = None, bitrate: int | None = None) -> str:
    with pytest.raises(ScenarioError) as found:
        Adapter(interface, channel, bitrate)
    text = str(found.value)
    assert "\n" not in text
    return text


@pytest.mark.usefixtures("no_settings")
@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (("sockectan", "vcan0"), ["unknown interface 'sockectan'; python-can knows", "socketcan", "virtual"]),
        ((None, "can0"), ["no interface", "named by -i, CAN_INTERFACE or ~/.canrc"]),
        (("socketcan", None), ["socketcan needs a channel, such as -c can0"]),
        (("socketcan", "nocan7"), ["socketcan nocan7 cannot be opened"]),
        (("slcan", "/dev/nothing"), ["slcan /dev/nothing cannot be opened", "there is no such device"]),
        (("slcan", None), ["slcan needs a channel: say which with -c"]),
        (("pcan", "PCAN_USBBUS1"), ["pcan PCAN_USBBUS1 cannot be opened"]),
    ],
)
def test_what_cannot_be_opened_is_told(asked: tuple[str | None, str | None], words: list[str]) -> None:
    said = refused(*asked)
    assert all(word in said for word in words), said


@pytest.mark.usefixtures("no_settings")
def test_a_bit_rate_that_the_adapter_does_not_have(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CAN_CONFIG", json.dumps({"sleep_after_open": 0}))
    with line() as far:
        assert "Invalid bitrate, choose one of 10000" in refused("slcan", far.path, 800_000)


@pytest.mark.usefixtures("no_settings")
def test_a_device_that_this_user_may_not_open(monkeypatch: pytest.MonkeyPatch) -> None:
    def forbid(*_: object, **__: object) -> None:
        raise PermissionError(13, "could not open port", "/dev/ttyACM0")

    monkeypatch.setattr("serial.serial_for_url", forbid)
    assert "permission denied; is this user in the device's group?" in refused("slcan", "/dev/ttyACM0")


def from_environment(patch: pytest.MonkeyPatch, _: Path) -> None:
    patch.setenv("CAN_INTERFACE", "virtual")
    patch.setenv("CAN_CHANNEL", "named")


def from_file(_: pytest.MonkeyPatch, home: Path) -> None:
    (home / ".canrc").write_text("[default]\ninterface = virtual\nchannel = named\n")


@pytest.mark.usefixtures("no_settings")
@pytest.mark.parametrize("say", [from_environment, from_file])
def test_names_come_from_where_python_can_looks(
    say: Callable[[pytest.MonkeyPatch, Path], None], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    say(monkeypatch, tmp_path)
    adapter = Adapter(None)
    assert adapter.name == "virtual named"
    adapter.close()


@pytest.mark.usefixtures("no_settings")
def test_a_file_that_python_can_cannot_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CAN_CONFIG", "{not json")
    assert "python-can's settings" in refused("virtual", "x")
