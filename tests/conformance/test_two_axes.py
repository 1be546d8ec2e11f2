"""A drive of another type: two axes in one node, rpm, PV only, no remapping. Differences are data."""

from __future__ import annotations

import pytest

from hilbed.can.drive_table import load_table
from hilbed.can.node import Node
from hilbed.conformance.ends import OtherDesk, on_the_wire
from hilbed.conformance.result import Result
from hilbed.conformance.subject import Subject
from hilbed.conformance.suite import Terms, perform
from tests.conformance.rig import BITRATE, failed

TABLE = load_table("zlac8015d")


def _examined(desk: OtherDesk, axis: int) -> dict[str, Result]:
    end = on_the_wire(desk, BITRATE)
    subject = Subject(end.link, Node("under test", 1, TABLE, axis=axis))
    return {result.check: result for result in perform(subject, Terms(True, 1.0, BITRATE, True))}


@pytest.mark.parametrize("axis", [1, 2])
def test_each_axis_passes_what_the_drive_has(axis: int) -> None:
    results = _examined(OtherDesk(1, TABLE), axis)
    assert failed(results) == set()
    assert {check for check, result in results.items() if result.status == "not supported"} == {
        "pdo/remap",
        "limits/speed",
        "limits/acceleration",
    }
    assert results["modes/pv"].status == "pass"
    assert "modes/csv" not in results


def test_only_the_axis_that_is_meant_turns() -> None:
    desk = OtherDesk(1, TABLE)
    end = on_the_wire(desk, BITRATE)
    subject = Subject(end.link, Node("under test", 1, TABLE, axis=2))
    subject.run(1.0)
    first, second = (motor.shaft for motor in desk.motors)
    # The second motor is mounted the other way round; 60FF has whole revolutions a minute.
    assert second.speed == pytest.approx(-1.0, abs=0.06)
    assert first.speed == pytest.approx(0.0, abs=1e-6)
    assert subject.settle() == []
    assert second.speed == pytest.approx(0.0, abs=0.02)
