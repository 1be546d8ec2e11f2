"""Drives that are told a position: the suite on a steering axis, in CSP and in PP, and on broken ones."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from firmware_sim import homing, place, profile_position
from hilbed.can.drive_table import load_table
from hilbed.conformance.command import subject_node
from hilbed.conformance.ends import on_the_wire
from hilbed.conformance.result import Result
from hilbed.conformance.subject import Subject
from hilbed.conformance.suite import Terms, perform
from hilbed.drive.desk import Desk
from tests.conformance.rig import BITRATE, NODE, drive, failed

MODES = pytest.mark.parametrize("mode", ["csp", "pp"])


def examined(desk: Desk, mode: str, speed: float = 1.0) -> dict[str, Result]:
    end = on_the_wire(desk, BITRATE)
    subject = Subject(end.link, subject_node(NODE, load_table(f"hilbed402-{mode}")))
    return {result.check: result for result in perform(subject, Terms(True, speed, BITRATE, end.exact))}


@MODES
@pytest.mark.parametrize("speed", [1.0, -0.6])
def test_the_benchs_own_axis_passes(mode: str, speed: float) -> None:
    results = examined(drive(), mode, speed)
    assert failed(results) == set()
    unsupported = {check for check, result in results.items() if result.status == "not supported"}
    assert unsupported == ({"set-points"} if mode == "csp" else set())
    assert {f"modes/{mode}", "homing", "position/there", "limits/position", "quick stop/time"} <= {*results}
    assert ("set-points/acknowledged" in results) is (mode == "pp")


def test_it_is_left_where_it_was_told_to_be() -> None:
    desk = drive()
    examined(desk, "csp")
    assert not desk.firmware.bridge_enabled
    assert abs(desk.shaft.speed) < 0.02


@pytest.mark.sources
@pytest.mark.parametrize(
    ("mode", "where", "name", "broken", "check"),
    [
        ("csp", place.Place, "goal", lambda self, target: target - self.home, "limits/position"),
        ("pp", place.Place, "limits", lambda *_: False, "limits/position is told"),
        ("pp", profile_position.ProfilePosition, "_acknowledge", lambda _: None, "set-points/acknowledged"),
        ("csp", homing.Homing, "_start", lambda *_: None, "homing"),
    ],
)
def test_it_finds_a_drive_that_does_not(
    mode: str,
    where: type,
    name: str,
    broken: Callable[..., object],
    check: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(where, name, broken)
    assert check in failed(examined(drive(), mode))
