"""What every Robot does: targets of its drives and its travel undo each other; so do command and twist."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.ports import Robot
from hilbed.robots import ROBOTS, DiffDriveSpec, TricycleSpec
from hilbed.robots.limited import Limited
from hilbed.types import Command

SPECS: list[tuple[Any, dict[str, Any]]] = [
    (DiffDriveSpec, {}),
    (TricycleSpec, {"drive": "front"}),
    (TricycleSpec, {"drive": "rear"}),
    (TricycleSpec, {"drive": "rear", "differential": False}),
]
sizes = st.floats(0.02, 2.0)
twists = st.tuples(st.floats(-5, 5), st.floats(-5, 5))


@st.composite
def robots(draw: st.DrawFn) -> Robot:
    """A robot of any kind and size."""
    spec, settings = draw(st.sampled_from(SPECS))
    block = spec.model_validate({"wheel_radius": draw(sizes), "track": draw(sizes), **settings})
    made: Robot = ROBOTS[block.kind](block)
    assert block.drives == made.drives
    return made


@given(robots(), twists)
def test_wheels_turned_as_commanded_travel_as_commanded(robot: Robot, twist: tuple[float, float]) -> None:
    command = robot.command(*twist)
    targets = robot.wheel_speeds(command)
    assert len(targets) == len(robot.drives) == len(set(robot.drives))
    assert robot.travel(targets) == pytest.approx(robot.twist(command), abs=1e-9)


@given(robots(), twists)
def test_a_command_is_the_inverse_of_its_twist(robot: Robot, twist: tuple[float, float]) -> None:
    """Within the limits, which once reached stay so."""
    command = robot.command(*twist)
    assert robot.limited(command) == command
    again = robot.twist(robot.command(*robot.twist(command)))
    assert again == pytest.approx(robot.twist(command), abs=1e-9)


@given(robots(), twists, st.floats(-3, 3))
def test_travel_grows_with_the_turn_of_the_wheels(
    robot: Robot, twist: tuple[float, float], factor: float
) -> None:
    """Twice the turn at the same steering angle is twice the way, along the same arc."""
    targets = dict(zip(robot.drives, robot.wheel_speeds(robot.command(*twist)), strict=True))
    longer = [x if name == "steering" else factor * x for name, x in targets.items()]
    way = robot.travel([*targets.values()])
    assert robot.travel(longer) == pytest.approx([factor * part for part in way], abs=1e-9)


@given(robots())
def test_it_stands_when_told_to_and_goes_ahead_without_turning(robot: Robot) -> None:
    assert robot.wheel_speeds(Command(0.0, 0.0)) == pytest.approx([0.0] * len(robot.drives))
    assert robot.travel(robot.wheel_speeds(Command(1.0, 0.0)))[1] == pytest.approx(0.0, abs=1e-12)


@given(robots(), twists, st.floats(0.1, 10))
def test_a_limit_of_the_wheels_slows_them_along_the_same_arc(
    robot: Robot, twist: tuple[float, float], limit: float
) -> None:
    command = robot.command(*twist)
    slowed = Limited(robot, [limit] * len(robot.drives))
    asked, given = robot.travel(robot.wheel_speeds(command)), slowed.travel(slowed.wheel_speeds(command))
    assert asked[0] * given[1] == pytest.approx(asked[1] * given[0], abs=1e-9)
    wheels = [
        x for x, name in zip(slowed.wheel_speeds(command), robot.drives, strict=True) if name != "steering"
    ]
    assert max(map(abs, wheels)) <= limit * (1 + 1e-12)
