"""What every Robot does: wheel speeds and travel undo each other, and both are linear."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.ports import Robot
from hilbed.robots import ROBOTS, RobotSpec
from hilbed.types import Command

SPECS: Iterable[Any] = get_args(RobotSpec) or (RobotSpec,)
sizes = st.floats(0.02, 2.0)
commands = st.builds(Command, st.floats(-5, 5), st.floats(-5, 5))


@st.composite
def robots(draw: st.DrawFn) -> Robot:
    """A robot of any kind and size."""
    spec = draw(st.sampled_from(list(SPECS)))
    block = spec(wheel_radius=draw(sizes), track=draw(sizes))
    made: Robot = ROBOTS[block.kind](block)
    return made


@given(robots(), commands)
def test_wheels_turned_as_commanded_travel_as_commanded(robot: Robot, command: Command) -> None:
    speeds = robot.wheel_speeds(command)
    assert len(speeds) == len(robot.drives) == len(set(robot.drives))
    assert robot.travel(speeds) == pytest.approx(command, abs=1e-9)


@given(robots(), commands, commands, st.floats(-3, 3))
def test_travel_is_linear(robot: Robot, a: Command, b: Command, factor: float) -> None:
    one, two = robot.wheel_speeds(a), robot.wheel_speeds(b)
    added = robot.travel([x + factor * y for x, y in zip(one, two, strict=True)])
    parts = [x + factor * y for x, y in zip(robot.travel(one), robot.travel(two), strict=True)]
    assert added == pytest.approx(parts, abs=1e-9)


@given(robots())
def test_it_stands_when_told_to_and_goes_ahead_without_turning(robot: Robot) -> None:
    assert robot.wheel_speeds(Command(0.0, 0.0)) == pytest.approx([0.0] * len(robot.drives))
    assert robot.travel(robot.wheel_speeds(Command(1.0, 0.0)))[1] == pytest.approx(0.0, abs=1e-12)
