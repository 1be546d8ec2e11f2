"""A drive against its data sheet; a data sheet that does not parse."""

from __future__ import annotations

from pathlib import Path

import canopen
import pytest

from firmware_sim import eds
from hilbed.conformance.eds import Promise, read_eds
from hilbed.types import ScenarioError
from tests.program.hilbed import hilbed


def test_it_reads_what_the_canopen_library_reads() -> None:
    library = canopen.import_od(str(eds.PATH))
    found = {(one.object, one.sub): one.size for one in read_eds(eds.PATH)}
    expected = {}
    for index in library:
        described = library[index]
        entries = [described] if hasattr(described, "data_type") else described.values()
        for entry in entries:
            if entry.readable:
                numeric = entry.data_type not in canopen.objectdictionary.DATA_TYPES
                expected[entry.index, entry.subindex] = len(entry) // 8 if numeric else None
    assert found == expected


def test_our_drive_keeps_what_its_data_sheet_promises() -> None:
    ended = hilbed("conformance", "-i", "hilbed", "--node", "3", "--eds", eds.PATH)
    assert (ended.status, ended.err) == (0, "")
    assert "pass          eds/entries" in ended.out


def test_a_promise_that_is_not_kept_is_told(tmp_path: Path) -> None:
    path = tmp_path / "more.eds"
    text = eds.PATH.read_text().replace("\n[6040]", "\n[60A9]")
    path.write_text(text)
    assert Promise(0x60A9, 0, 2) in read_eds(path)
    ended = hilbed("conformance", "-i", "hilbed", "--node", "3", "--eds", path)
    assert ended.status == 1
    assert "1 are not as promised: 60A9:00 abort 06020000" in ended.out


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[6040]\nthis is nothing\n", ":2: neither"),
        ("DataType=7\n", ":1: "),
        ("[6040]\nDataType=7\n[6040]\n", ":3: "),
        ("[6040]\nDataType=seven\nAccessType=ro\n", "[6040] DataType='seven'"),
        ("", "no object"),
        ("\0\xff", ":1: "),
    ],
)
def test_one_that_does_not_parse_is_told(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "broken.eds"
    path.write_text(text, encoding="latin-1")
    with pytest.raises(ScenarioError) as told:
        read_eds(path)
    assert str(path) in str(told.value)
    assert words in str(told.value)


def test_bad_options_end_with_4(tmp_path: Path) -> None:
    for arguments in (
        ("--node", "0"),
        ("--node", "1", "--speed", "nan"),
        ("--node", "1", "--speed", "0"),
        ("--node", "1", "--axis", "2"),
        ("--node", "1", "--drive", "nonsense"),
        ("--node", "1", "--eds", tmp_path / "none.eds"),
    ):
        ended = hilbed("conformance", "-i", "hilbed", *map(str, arguments))
        assert (ended.status, ended.out) == (4, "")
        assert "Traceback" not in ended.err


def test_a_report_is_not_overwritten(tmp_path: Path) -> None:
    assert hilbed("conformance", "-i", "hilbed", "--node", "1", "--out", tmp_path / "a").status == 0
    ended = hilbed("conformance", "-i", "hilbed", "--node", "1", "--out", tmp_path / "a")
    assert ended.status == 4
    assert "exists" in ended.err
