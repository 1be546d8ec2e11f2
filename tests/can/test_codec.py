"""PDO mappings of the tables against cantools, which reads them from a DBC."""

from __future__ import annotations

import struct

import cantools
import pytest
from cantools.database import Message
from cantools.database.can import Database
from hypothesis import given
from hypothesis import strategies as st

from hilbed.can.codec import PdoCodec, bit_length, limits
from hilbed.can.drive_table import bundled_tables, load_table

TYPES = ("i8", "u8", "i16", "u16", "i32", "u32")


def dbc(fields: list[tuple[str, str]]) -> str:
    """Writes the mapping as a DBC: little endian signals one after another."""
    lines, start = (
        ['VERSION ""', "BU_: A B", f"BO_ 385 PDO: {sum(bit_length(t) for _, t in fields) // 8} A"],
        0,
    )
    for name, data_type in fields:
        sign = "-" if data_type[0] == "i" else "+"
        lines.append(f' SG_ {name} : {start}|{bit_length(data_type)}@1{sign} (1,0) [0|0] "" B')
        start += bit_length(data_type)
    return "\n".join(lines) + "\n"


def read_dbc(text: str) -> Message:
    database = cantools.database.load_string(text, "dbc")
    assert isinstance(database, Database)
    return database.messages[0]


@st.composite
def mappings(draw: st.DrawFn) -> tuple[list[tuple[str, str]], dict[str, float]]:
    types = draw(st.lists(st.sampled_from(TYPES), min_size=1, max_size=8))
    while sum(map(bit_length, types)) > 64:
        types.pop()
    fields = [(f"signal_{i}", data_type) for i, data_type in enumerate(types)]
    values: dict[str, float] = {name: draw(st.integers(*limits(data_type))) for name, data_type in fields}
    return fields, values


@given(mappings())
def test_same_bytes_and_values_as_cantools(drawn: tuple[list[tuple[str, str]], dict[str, float]]) -> None:
    fields, values = drawn
    codec = PdoCodec(fields)
    message = read_dbc(dbc(fields))
    data = codec.encode(values)
    assert data == message.encode(values)
    assert codec.decode(data) == message.decode(data) == values


@pytest.mark.parametrize("name", bundled_tables())
def test_pdos_of_the_tables(name: str) -> None:
    table = load_table(name)
    for pdo in table.pdos:
        fields = [(f"{value.word}_{value.axis}", value.type) for value in table.values(pdo)]
        codec = PdoCodec(fields)
        message = read_dbc(dbc([(word, str(data_type)) for word, data_type in fields]))
        data = bytes(range(0x81, 0x81 + codec.size))
        assert codec.decode(data) == message.decode(data)


def test_a_wrong_length_is_an_error_of_struct() -> None:
    with pytest.raises(struct.error):
        PdoCodec([("a", "i16")]).unpack(b"123")
