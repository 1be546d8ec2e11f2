"""What a run says of its own cost."""

from __future__ import annotations

from hilbed.runner import perform
from hilbed.scenario.load import load


def test_parts_are_never_more_than_the_whole() -> None:
    """Boot and the stop afterwards take longer than so few cycles, and belong to neither."""
    verdict = perform(load("slimane2014/load-torque", ["duration=0.05"]), None).verdict
    assert all(spent >= 0 for spent in verdict["cost"].values())
    assert 0 < sum(verdict["cost"].values()) < verdict["wall_time"]
