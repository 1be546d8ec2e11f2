"""Frame lengths against a count that lays out and stuffs every single bit."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.can.frame_length import INTERFRAME_BITS, crc15, frame_bits
from hilbed.can.load import worst_bits
from hilbed.types import BusError, Frame


def header_bits(frame: Frame) -> str:
    length = format(len(frame.data), "04b")
    remote = "1" if frame.remote else "0"
    if frame.extended:
        identifier = format(frame.id, "029b")
        return "0" + identifier[:11] + "11" + identifier[11:] + remote + "00" + length
    return "0" + format(frame.id, "011b") + remote + "00" + length


def crc_of_bits(bits: str) -> str:
    """Long division of the message polynomial by x^15+x^14+x^10+x^8+x^7+x^4+x^3+1."""
    divisor = "1100010110011001"
    rest = list(bits + "0" * 15)
    for i in range(len(bits)):
        if rest[i] == "1":
            for j, bit in enumerate(divisor):
                rest[i + j] = "0" if rest[i + j] == bit else "1"
    return "".join(rest[-15:])


def stuffed(bits: str) -> str:
    sent = ""
    for bit in bits:
        sent += bit
        if len(sent) >= 5 and sent[-5:] in ("00000", "11111") and _run(sent) == 5:
            sent += "1" if bit == "0" else "0"
    return sent


def _run(sent: str) -> int:
    return len(sent) - len(sent.rstrip(sent[-1]))


def counted(frame: Frame) -> int:
    bits = header_bits(frame)
    if not frame.remote:
        bits += "".join(format(byte, "08b") for byte in frame.data)
    return len(stuffed(bits + crc_of_bits(bits))) + 1 + 2 + 7


@st.composite
def frames(draw: st.DrawFn) -> Frame:
    extended = draw(st.booleans())
    identifier = draw(st.integers(0, (1 << 29 if extended else 1 << 11) - 1))
    runs = st.sampled_from([0x00, 0xFF, 0x1F, 0xE0, 0x0F, 0xF8])
    data = bytes(draw(st.lists(runs | st.integers(0, 255), max_size=8)))
    return Frame(identifier, data, extended, draw(st.booleans()))


@given(frames())
def test_length_is_that_of_a_bit_by_bit_count(frame: Frame) -> None:
    assert frame_bits(frame) == counted(frame)


@given(frames())
def test_length_is_within_the_bounds_of_the_standard(frame: Frame) -> None:
    size = 0 if frame.remote else len(frame.data)
    least = (64 if frame.extended else 44) + 8 * size
    assert least <= frame_bits(frame) <= worst_bits(size, frame.extended) - INTERFRAME_BITS


def test_every_standard_header_without_data() -> None:
    for identifier in range(0, 2048, 7):
        frame = Frame(identifier)
        assert frame_bits(frame) == counted(frame)


def test_crc_check_value() -> None:
    assert crc15(b"123456789") == 0x059E


def test_crc_is_that_of_long_division() -> None:
    bits = "".join(format(byte, "08b") for byte in b"123456789")
    assert int(crc_of_bits(bits), 2) == 0x059E


@pytest.mark.parametrize(
    "frame",
    [
        Frame(0x800),
        Frame(-1),
        Frame(1 << 29, extended=True),
        Frame(1, bytes(9)),
        Frame(1, bytes(9), remote=True),
    ],
)
def test_what_is_no_frame_is_refused(frame: Frame) -> None:
    with pytest.raises(BusError, match="no CAN frame"):
        frame_bits(frame)
