"""The trapezoid of profile position mode against its closed form."""

from __future__ import annotations

from math import sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from firmware_sim.course import Straight, Trapezoid


def trapezoid(way: float, most: float, rise: float, fall: float, t: float) -> float:
    """Returns where a move from rest to rest is at t: speeds up, keeps its speed if it gets to it, brakes."""
    top = min(most, sqrt(2 * way * rise * fall / (rise + fall)))
    up, down = top / rise, top / fall
    flat = (way - top * (up + down) / 2) / top
    if t < up:
        return rise * t**2 / 2
    if t < up + flat:
        return top * (t - up / 2)
    left = max(up + flat + down - t, 0.0)
    return way - fall * left**2 / 2


def course(goal: float, most: float, rise: float, fall: float) -> Trapezoid:
    made = Trapezoid()
    made.goal, made.most, made.rise, made.fall = goal, most, rise, fall
    return made


def ticks(made: Trapezoid, demand: float, count: int) -> list[float]:
    """Returns where the demand is after each tick."""
    found = []
    for _ in range(count):
        demand += made.step(demand)
        found.append(demand)
    return found


@pytest.mark.parametrize(
    ("way", "most", "rise", "fall"),
    [(1000.0, 5.0, 0.1, 0.1), (1000.0, 5.0, 0.1, 0.4), (60.0, 5.0, 0.1, 0.3), (-400.0, 2.0, 0.05, 0.02)],
    ids=["flat top", "brakes harder", "no flat top", "back"],
)
def test_it_is_the_closed_form(way: float, most: float, rise: float, fall: float) -> None:
    found = ticks(course(way, most, rise, fall), 0.0, 700)
    ahead = 1.0 if way > 0 else -1.0
    expected = [ahead * trapezoid(abs(way), most, rise, fall, t) for t in range(1, 701)]
    # A corner of the trapezoid lies within a tick, and is cut by an eighth of a ramp's step.
    assert found == pytest.approx(expected, abs=max(rise, fall))
    assert found[-1] == way


@given(st.floats(-1e3, 1e3), st.floats(-20, 20), st.floats(1, 50), st.floats(0.05, 5), st.floats(0.05, 5))
def test_from_any_speed_it_comes_to_rest_at_its_goal(
    goal: float, speed: float, most: float, rise: float, fall: float
) -> None:
    made, demand = course(goal, most, rise, fall), 0.0
    made.speed = speed
    for _ in range(10_000):
        before = made.speed
        demand += made.step(demand)
        assert abs(made.speed) <= max(most, abs(before))
        change = rise if abs(made.speed) > abs(before) else fall
        assert abs(made.speed - before) <= change * (1 + 1e-9)
        if made.speed == 0.0 and abs(goal - demand) < 1e-6:
            return
    raise AssertionError(f"it is at {demand}, not at {goal}")


def test_a_goal_that_is_too_near_is_passed_and_come_back_to() -> None:
    made = course(10.0, 5.0, 0.1, 0.1)
    made.speed = 5.0
    found = ticks(made, 0.0, 400)
    assert max(found) == pytest.approx(5.0**2 / 0.2, abs=0.1)  # v²/2a
    assert found[-1] == 10.0


def test_without_a_speed_it_stands() -> None:
    assert ticks(course(100.0, 0.0, 0.1, 0.1), 3.0, 10) == [3.0] * 10


def test_straight_lines_take_the_period_or_longer() -> None:
    line, demand, found = Straight(), 0.0, []
    line.aim(10.0, demand, 4.0, 100.0)
    for _ in range(5):
        demand += line.step(demand)
        found.append(demand)
    assert found == [2.5, 5.0, 7.5, 10.0, 10.0]
    line.aim(-10.0, demand, 4.0, 2.0)
    assert line.step(demand) == -2.0
