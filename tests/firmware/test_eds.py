"""The data sheet against the canopen library's reading of it and against the drive itself."""

from __future__ import annotations

from typing import Any

import canopen
import pytest
from canopen.objectdictionary import ODArray, ODRecord, ODVariable

from firmware_sim import eds
from firmware_sim.dictionary import ENTRIES
from firmware_sim.entry import ARRAY, RECORD, VAR, Entry, Object
from firmware_sim.objects import OBJECTS
from tests.firmware.wire import NODE, powered

KINDS = {VAR: ODVariable, ARRAY: ODArray, RECORD: ODRecord}
PAIRS = [(o, e) for o in OBJECTS for e in o.entries]


@pytest.fixture(scope="module")
def sheet() -> Any:
    return canopen.import_od(str(eds.PATH), NODE)


def test_the_file_is_what_the_dictionary_says() -> None:
    assert eds.PATH.read_text(encoding="ascii") == eds.text()


def test_it_holds_the_same_objects(sheet: Any) -> None:
    assert sorted(sheet) == [o.index for o in OBJECTS]
    for described in OBJECTS:
        assert type(sheet[described.index]) is KINDS[described.kind]
        if described.kind != VAR:
            assert sorted(sheet[described.index].subindices) == [e.sub for e in described.entries]


@pytest.mark.parametrize(("described", "entry"), PAIRS, ids=[f"{o.index:X}-{e.sub:X}" for o, e in PAIRS])
def test_every_entry_is_the_same(sheet: Any, described: Object, entry: Entry) -> None:
    read = sheet.get_variable(described.index, entry.sub)
    assert read.data_type == entry.type.code
    assert read.access_type == entry.access
    assert read.pdo_mappable == entry.mappable
    assert read.default == (entry.default + NODE if entry.relative else entry.default)
    assert read.writable == entry.writable
    if entry.type.format != "f":  # the library reads no limits of reals
        assert read.min == (entry.choices[0] if entry.choices else entry.low)
        assert read.max == (entry.choices[-1] if entry.choices else entry.high)


def test_the_drive_answers_every_entry_with_its_default() -> None:
    wire = powered()
    live = {0x6041: 0x0250, 0x6079: 24_000}  # switch on disabled, voltage, remote; supply in mV
    for described, entry in PAIRS:
        data = wire.node.sdo.upload(described.index, entry.sub)
        expected = wire.node.object_dictionary.get_variable(described.index, entry.sub)
        default = live.get(described.index, expected.default)
        if entry.type.format == "f":
            default = pytest.approx(default, rel=1e-6)
        assert expected.decode_raw(data) == default, hex(described.index)


def test_no_entry_refuses_its_own_default() -> None:
    for entry in ENTRIES.values():
        entry.check(entry.default)
