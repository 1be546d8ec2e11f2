"""The SDO server under the canopen library's client, and under clients that break the rules."""

from __future__ import annotations

import struct

import canopen
import pytest

from firmware_sim import Frame
from tests.firmware.wire import NODE, Wire, powered

REQUEST, ANSWER = 0x600 + NODE, 0x580 + NODE


def raw(wire: Wire, data: bytes) -> bytes:
    """Sends eight bytes and returns the one answer."""
    wire.take(ANSWER)
    wire.send_message(REQUEST, data.ljust(8, b"\0"))
    (answer,) = wire.take(ANSWER)
    assert len(answer) == 8
    return answer


def code(answer: bytes) -> int:
    assert answer[0] == 0x80
    return int(struct.unpack_from("<I", answer, 4)[0])


@pytest.mark.parametrize("segmented", [False, True])
@pytest.mark.parametrize(
    ("index", "sub", "value"),
    [
        (0x607E, 0, b"\x40"),
        (0x1017, 0, b"\x2c\x01"),
        (0x60FF, 0, struct.pack("<i", -123456)),
        (0x2010, 2, struct.pack("<f", 0.25)),
        (0x2000, 0, b"left wheel"),
        (0x2000, 0, b"exactly fourteen"[:14]),
        (0x2000, 0, b"x" * 32),
    ],
)
def test_what_is_downloaded_is_uploaded(index: int, sub: int, value: bytes, segmented: bool) -> None:
    wire = powered()
    wire.node.sdo.download(index, sub, value, force_segment=segmented)
    assert wire.node.sdo.upload(index, sub) == value


def test_a_constant_text_comes_in_segments() -> None:
    assert powered().node.sdo[0x1008].raw == "hilbed simulated drive"


def test_an_empty_text_is_a_transfer_of_no_bytes() -> None:
    wire = powered()
    wire.node.sdo.download(0x2000, 0, b"something")
    wire.node.sdo.download(0x2000, 0, b"")
    assert raw(wire, b"\x40\x00\x20\x00") == b"\x41\x00\x20\x00" + bytes(4)
    assert raw(wire, b"\x60") == b"\x0f" + bytes(7)


def test_an_expedited_download_without_size_takes_the_objects_own() -> None:
    wire = powered()
    assert raw(wire, b"\x22\x17\x10\x00\x64\x00\xff\xff")[0] == 0x60
    assert wire.node.sdo[0x1017].raw == 100


@pytest.mark.parametrize(
    ("index", "sub", "value", "expected"),
    [
        (0x5FFF, 0, b"\0", 0x06020000),  # no such object
        (0x6040, 1, b"\0\0", 0x06090011),  # no such sub-index
        (0x6041, 0, b"\0\0", 0x06010002),  # read only
        (0x1008, 0, b"abc", 0x06010002),  # constant
        (0x6040, 0, b"\0\0\0", 0x06070012),  # too long
        (0x6040, 0, b"\0", 0x06070013),  # too short
        (0x2000, 0, b"x" * 33, 0x06070012),  # text too long
        (0x2000, 0, b"\x07bell", 0x06090030),  # not printable
        (0x6060, 0, b"\x07", 0x06090030),  # a mode that is not there
        (0x605A, 0, b"\x04\0", 0x06090030),  # an option that is not there
        (0x6083, 0, bytes(4), 0x06090032),  # too low
        (0x2003, 0, struct.pack("<I", 500_000), 0x06090031),  # too high
        (0x2010, 1, b"\x03", 0x06090031),  # no such loop
        (0x2012, 1, struct.pack("<f", 0.0), 0x06090032),  # a motor without resistance
        (0x2010, 2, struct.pack("<f", float("nan")), 0x06090030),
        (0x2010, 2, struct.pack("<f", float("inf")), 0x06090030),
        (0x1003, 0, b"\x01", 0x06090030),  # only zero, which clears
        (0x1005, 0, struct.pack("<I", 0x40000080), 0x06090030),  # no SYNC producer
        (0x1005, 0, struct.pack("<I", 0x605), 0x06090030),  # an identifier of SDO
        (0x1016, 1, struct.pack("<I", 0x00FF_0064), 0x06090031),  # node 255
        (0x1400, 1, struct.pack("<I", 0x20000205), 0x06090030),  # 29 bits
        (0x1800, 2, b"\xf1", 0x06090030),  # reserved transmission type
    ],
)
def test_the_right_abort_for_every_wrong_write(index: int, sub: int, value: bytes, expected: int) -> None:
    wire = powered()
    wire.node.sdo.upload(0x6041, 0)  # actual values are fresh from here on
    before = wire.drive._node._values.copy()
    for segmented in (False, True):
        with pytest.raises(canopen.SdoAbortedError) as error:
            wire.node.sdo.download(index, sub, value, force_segment=segmented)
        assert error.value.code == expected
    assert wire.drive._node._values == before


def test_one_node_is_watched_once() -> None:
    wire = powered()
    wire.node.sdo[0x1016][1].raw = 0x7F_0064
    with pytest.raises(canopen.SdoAbortedError) as error:
        wire.node.sdo[0x1016][2].raw = 0x7F_0032
    assert error.value.code == 0x06040043
    wire.node.sdo[0x1016][1].raw = 0x7F_0032  # the same entry again is a change


def test_reading_what_is_not_there() -> None:
    wire = powered()
    for index, sub, expected in ((0x3000, 0, 0x06020000), (0x1018, 9, 0x06090011)):
        with pytest.raises(canopen.SdoAbortedError) as error:
            wire.node.sdo.upload(index, sub)
        assert error.value.code == expected


def test_a_toggle_bit_that_does_not_alternate() -> None:
    wire = powered()
    raw(wire, b"\x40\x08\x10\x00")
    assert raw(wire, b"\x60")[0] == 0x00
    assert raw(wire, b"\x60") == b"\x80\x08\x10\x00" + struct.pack("<I", 0x05030000)
    assert code(raw(wire, b"\x70")) == 0x05040001  # the transfer is over


def test_a_download_toggle_that_does_not_alternate() -> None:
    wire = powered()
    raw(wire, b"\x21\x00\x20\x00\x0a\0\0\0")
    assert code(raw(wire, b"\x10abcdefg")) == 0x05030000
    assert wire.node.sdo.upload(0x2000, 0) == b""


def test_a_size_that_was_announced_and_not_kept() -> None:
    wire = powered()
    raw(wire, b"\x21\x00\x20\x00\x0a\0\0\0")
    assert code(raw(wire, b"\x01abcdefg")) == 0x06070010


def test_more_than_fits_without_a_size_announced() -> None:
    wire = powered()
    raw(wire, b"\x20\x00\x20\x00")
    for toggle in (0x00, 0x10, 0x00, 0x10):
        assert raw(wire, bytes((toggle,)) + b"abcdefg")[0] == 0x20 | toggle
    assert code(raw(wire, b"\x00abcdefg")) == 0x06070012


@pytest.mark.parametrize(
    ("request_", "named"),
    [
        (b"\xa0\x17\x10\x01", b"\x17\x10\x01"),  # blocks name their object
        (b"\xc0\x17\x10\x01", b"\x17\x10\x01"),
        (b"\xe0\x17\x10\x01", b"\x17\x10\x01"),
        (b"\x00\x17\x10\x01", b"\0\0\0"),  # in a segment these bytes are data
        (b"\x60\x17\x10\x01", b"\0\0\0"),
    ],
)
def test_blocks_and_segments_out_of_the_blue(request_: bytes, named: bytes) -> None:
    assert raw(powered(), request_) == b"\x80" + named + struct.pack("<I", 0x05040001)


@pytest.mark.parametrize("text", [b"a", b"abc", b"abcd", b"abcde"])
def test_how_a_text_is_uploaded(text: bytes) -> None:
    """At most four bytes go into the answer itself, which tells how many it does not use."""
    wire = powered()
    wire.node.sdo.download(0x2000, 0, text)
    answer = raw(wire, b"\x40\x00\x20\x00")
    if len(text) > 4:
        assert answer == b"\x41\x00\x20\x00" + struct.pack("<I", len(text))
    else:
        assert answer == bytes((0x43 | (4 - len(text)) << 2,)) + b"\x00\x20\x00" + text.ljust(4, b"\0")


def test_a_download_whose_size_was_not_announced() -> None:
    wire = powered()
    raw(wire, b"\x20\x00\x20\x00\x63\0\0\0")  # four bytes that mean nothing
    assert raw(wire, b"\x00abcdefg") == b"\x20" + bytes(7)
    assert raw(wire, b"\x1bhi") == b"\x30" + bytes(7)
    assert wire.node.sdo.upload(0x2000, 0) == b"abcdefghi"


@pytest.mark.parametrize("segment", [b"\x01x", b"\x11x", b"\x60", b"\x70"])
@pytest.mark.parametrize(
    "requests",
    [
        [b"\x21\x00\x20\x00\x01\0\0\0", b"\x0dx"],  # a download to its end
        [b"\x21\x00\x20\x00\x0a\0\0\0", b"\x2b\x17\x10\x00\x64"],  # left for another one
        [b"\x21\x00\x20\x00\x0a\0\0\0", b"\x40\x17\x10\x00"],
        [b"\x40\x08\x10\x00", b"\x60", b"\x70", b"\x60", b"\x70"],  # an upload to its end
        [b"\x40\x08\x10\x00", b"\x2b\x17\x10\x00\x64"],
        [b"\x40\x08\x10\x00", b"\x40\x17\x10\x00"],
        [b"\x40\x08\x10\x00", b"\x40\x17\x10\x07"],  # left for one that is refused
    ],
)
def test_a_transfer_that_has_ended_goes_no_further(requests: list[bytes], segment: bytes) -> None:
    wire = powered()
    for request in requests:
        raw(wire, request)
    assert raw(wire, segment) == b"\x80\0\0\0" + struct.pack("<I", 0x05040001)
    wire.take(ANSWER)
    wire.run(1100)
    assert wire.take(ANSWER) == []  # nor is it given up later


def test_an_abort_of_the_client_ends_the_transfer_without_an_answer() -> None:
    wire = powered()
    raw(wire, b"\x40\x08\x10\x00")
    wire.send_message(REQUEST, b"\x80\x08\x10\x00" + bytes(4))
    wire.run(1100)
    assert wire.take(ANSWER) == []
    assert code(raw(wire, b"\x60")) == 0x05040001


def test_a_client_that_falls_silent_is_given_up() -> None:
    wire = powered()
    raw(wire, b"\x40\x08\x10\x00")
    wire.run(999)
    assert wire.take(ANSWER) == []
    wire.run(2)
    (abort,) = wire.take(ANSWER)
    assert abort == b"\x80\x08\x10\x00" + struct.pack("<I", 0x05040000)


def test_frames_that_are_no_requests() -> None:
    wire = powered()
    for length in (0, 1, 7):
        wire.send_message(REQUEST, bytes(length))
    assert wire.drive.malformed == 3
    wire.drive.on_frame(wire.t, Frame(REQUEST, b"\x40\x08\x10\x00" + bytes(4), extended=True))
    wire.drive.on_frame(wire.t, Frame(REQUEST, b"", remote=True))
    assert not wire.drive.outbox
