"""The tools for the bench on a real SocketCAN bus, against drives that are processes of their own."""

from __future__ import annotations

import json
from pathlib import Path

from tests.hil.processes import ON_VCAN, drive, on_the_bus
from tests.program.hilbed import hilbed

TIMING = ("sync/", "load/")
"""Checks that a computer with one busy processor may fail: the drive is a process on it, too."""


def test_a_scan_finds_the_drives() -> None:
    with on_the_bus(drive(5), drive(9)):
        ended = hilbed("bus", "scan", *ON_VCAN, "--listen", "0.2", "--json")
    assert (ended.status, ended.err) == (0, "")
    found = json.loads(ended.out)
    assert [(node["node"], node["table"], node["power"]) for node in found] == [
        (5, "hilbed402", "switch on disabled"),
        (9, "hilbed402", "switch on disabled"),
    ]


def test_a_drive_passes_the_suite_and_is_left_at_rest(tmp_path: Path) -> None:
    with on_the_bus(drive(5)):
        ended = hilbed("conformance", *ON_VCAN, "--node", "5", "--arm", "--out", tmp_path, "--json")
        after = json.loads(hilbed("bus", "scan", *ON_VCAN, "--listen", "0", "--json").out)
    report = json.loads(ended.out)
    assert report == json.loads((tmp_path / "conformance.json").read_text())
    failed = [check for check in report["checks"] if check["status"] == "fail"]
    assert [check for check in failed if not check["check"].startswith(TIMING)] == []
    assert ended.status == (1 if failed else 0)
    assert report["summary"]["pass"] > 50
    assert "highest load" in next(one["note"] for one in report["checks"] if one["check"] == "load/reached")
    assert after[0]["power"] == "switch on disabled"


def test_a_node_that_is_not_there_is_told() -> None:
    ended = hilbed("conformance", *ON_VCAN, "--node", "99")
    assert ended.status == 7
    assert "node 99" in ended.err
    assert "Traceback" not in ended.err
