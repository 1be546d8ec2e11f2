"""The SDO client against the server of the `canopen` library and against misbehaving servers."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from struct import pack

import can
import canopen
import pytest
from canopen.objectdictionary import ODVariable, datatypes
from hypothesis import given, settings
from hypothesis import strategies as st

from hilbed.can.link import Link
from hilbed.can.port import Port
from hilbed.can.sdo import SdoClient
from hilbed.can.wire import Wire
from hilbed.clock import MILLISECOND
from hilbed.types import BusError, Frame, Nanos

NODE = 5
Server = Callable[[Frame], list[bytes]]


def client(wire: Wire) -> SdoClient:
    wire.advance(0)

    def pump(t: Nanos) -> Nanos:
        wire.advance(t + MILLISECOND)
        return t + MILLISECOND

    link = Link(wire.attach("controller"), pump, 0, limit=60_000 * MILLISECOND)
    return SdoClient(link, "left", NODE)


class CanopenBus:
    """What canopen.Network needs of a python-can bus."""

    def __init__(self, wire: Wire, network: canopen.Network) -> None:
        self._wire = wire
        self._port = wire.attach("server", lambda t, f: network.notify(f.id, bytearray(f.data), t / 1e9))

    def send(self, message: can.Message) -> None:
        self._port.send(self._wire.now, Frame(message.arbitration_id, bytes(message.data)))


def dictionary() -> canopen.ObjectDictionary:
    objects = canopen.ObjectDictionary()  # type: ignore[no-untyped-call]
    for index, data_type, access in (
        (0x2000, datatypes.UNSIGNED8, "rw"),
        (0x2001, datatypes.INTEGER16, "rw"),
        (0x2002, datatypes.INTEGER32, "rw"),
        (0x2003, datatypes.REAL32, "rw"),
        (0x2004, datatypes.DOMAIN, "rw"),
        (0x2005, datatypes.UNSIGNED32, "ro"),
        (0x2006, datatypes.UNSIGNED64, "rw"),
    ):
        variable = ODVariable(f"object {index:04X}", index, 0)
        variable.data_type, variable.access_type = data_type, access
        variable.default = 7
        objects.add_object(variable)
    return objects


@pytest.fixture(scope="module")
def library() -> tuple[SdoClient, canopen.LocalNode]:
    wire, network = Wire(500_000), canopen.Network()
    network.bus = CanopenBus(wire, network)  # type: ignore[assignment]
    node = canopen.LocalNode(NODE, dictionary())
    network.add_node(node)
    return client(wire), node


@settings(deadline=None, max_examples=50)
@given(st.binary(min_size=1, max_size=300))
def test_bytes_of_any_length_go_there_and_back(
    library: tuple[SdoClient, canopen.LocalNode], data: bytes
) -> None:
    sdo, node = library
    sdo.download(0x2004, 0, data)
    assert bytes(node.get_data(0x2004, 0)) == data
    assert sdo.upload(0x2004, 0) == data


@pytest.mark.parametrize(
    ("index", "data_type", "value"),
    [
        (0x2000, "u8", 200),
        (0x2001, "i16", -1234),
        (0x2002, "i32", -(2**31)),
        (0x2006, "u64", 2**63 + 1),
    ],
)
def test_numbers(
    library: tuple[SdoClient, canopen.LocalNode], index: int, data_type: str, value: int
) -> None:
    sdo, node = library
    sdo.write(index, 0, data_type, value)
    variable = node.object_dictionary[index]
    assert isinstance(variable, ODVariable)
    assert variable.decode_raw(bytes(node.get_data(index, 0))) == value
    assert sdo.read(index, 0, data_type) == value


def test_floats(library: tuple[SdoClient, canopen.LocalNode]) -> None:
    sdo, node = library
    sdo.write(0x2003, 0, "f32", 0.11)
    assert bytes(node.get_data(0x2003, 0)) == pack("<f", 0.11)


def test_aborts_name_drive_object_and_reason(library: tuple[SdoClient, canopen.LocalNode]) -> None:
    sdo, _ = library
    with pytest.raises(BusError, match=r"drive left \(node 5\).*2005:00.*can only be read.*06010002"):
        sdo.write(0x2005, 0, "u32", 1)
    with pytest.raises(BusError, match=r"3000:01.*object does not exist.*06020000"):
        sdo.read(0x3000, 1, "u32")


def test_a_value_that_does_not_fit_is_not_sent(library: tuple[SdoClient, canopen.LocalNode]) -> None:
    sdo, _ = library
    with pytest.raises(BusError, match=r"300 does not fit 2000:00, a u8"):
        sdo.write(0x2000, 0, "u8", 300)
    with pytest.raises(BusError, match="does not fit"):
        sdo.write(0x2003, 0, "f32", 1e300)


def test_a_wrong_length_is_told(library: tuple[SdoClient, canopen.LocalNode]) -> None:
    sdo, _ = library
    sdo.write(0x2000, 0, "u8", 1)
    with pytest.raises(BusError, match="2000:00 has 1 bytes, not a u32"):
        sdo.read(0x2000, 0, "u32")


def scripted(serve: Server) -> tuple[SdoClient, list[Frame]]:
    """A client and all requests that a server with the given answers has got."""
    wire, requests, ports = Wire(500_000), list[Frame](), list[Port]()

    def on_frame(t: Nanos, frame: Frame) -> None:
        requests.append(frame)
        for answer in serve(frame):
            ports[0].send(t, Frame(0x580 + NODE, answer))

    ports.append(wire.attach("server", on_frame))
    return client(wire), requests


def abort_code(frame: Frame) -> int:
    assert frame.data[0] == 0x80
    return int.from_bytes(frame.data[4:], "little")


def test_silence_is_told_after_the_deadline_and_aborted() -> None:
    sdo, requests = scripted(lambda _: [])
    with pytest.raises(BusError, match=r"node 5.*1018:01.*no answer in time"):
        sdo.read(0x1018, 1, "u32")
    assert len(requests) == 1  # the abort is still on its way


def test_a_late_answer_to_another_object_is_passed_over() -> None:
    def serve(frame: Frame) -> list[bytes]:
        late = bytes.fromhex("43 00 10 00 FFFFFFFF")
        return [late, b"\x43" + frame.data[1:4] + bytes((1, 0, 0, 0))]

    sdo, _ = scripted(serve)
    assert sdo.read(0x1018, 1, "u32") == 1


def test_an_endless_upload_is_cut_off() -> None:
    def serve(frame: Frame) -> list[bytes]:
        if frame.data[0] == 0x40:
            return [b"\x40" + frame.data[1:4] + bytes(4)]
        return [bytes((frame.data[0] & 0x10,)) + b"forever"]

    sdo, _ = scripted(serve)
    with pytest.raises(BusError, match="out of memory"):
        sdo.upload(0x1008, 0)


def test_a_toggle_bit_that_sticks_is_told() -> None:
    def serve(frame: Frame) -> list[bytes]:
        if frame.data[0] == 0x40:
            return [b"\x40" + frame.data[1:4] + bytes(4)]
        return [b"\x00" + b"abcdefg"] if frame.data[0] < 0x80 else []

    sdo, _ = scripted(serve)
    with pytest.raises(BusError, match="toggle"):
        sdo.upload(0x1008, 0)


def test_a_wrong_announcement_of_size_is_told() -> None:
    def serve(frame: Frame) -> list[bytes]:
        if frame.data[0] == 0x40:
            return [b"\x41" + frame.data[1:4] + bytes((9, 0, 0, 0))]
        return [b"\x01" + b"abcdefg"]

    sdo, _ = scripted(serve)
    with pytest.raises(BusError, match="sent 7 bytes after announcing 9"):
        sdo.upload(0x1008, 0)


@settings(deadline=None, max_examples=200)
@given(st.lists(st.binary(max_size=8), max_size=4), st.sampled_from(["read", "upload", "download"]))
def test_garbage_is_an_error_of_the_bus_or_an_answer(answers: list[bytes], action: str) -> None:
    sdo, _ = scripted(lambda _: answers)
    actions: dict[str, Callable[[], object]] = {
        "read": lambda: sdo.read(0x1018, 1, "u32"),
        "upload": lambda: sdo.upload(0x1018, 1),
        "download": lambda: sdo.download(0x1018, 1, b"something long"),
    }
    with contextlib.suppress(BusError):
        actions[action]()


def test_an_unknown_command_is_answered_with_an_abort() -> None:
    sdo, requests = scripted(lambda frame: [b"\xe0" + frame.data[1:4] + bytes(4)])
    with pytest.raises(BusError, match="unknown command"):
        sdo.read(0x1018, 1, "u32")
    with pytest.raises(BusError, match="unknown command"):  # a second exchange lets the abort arrive
        sdo.read(0x1018, 1, "u32")
    assert abort_code(requests[1]) == 0x05040001
