"""Real time against a clock of our own: absolute deadlines, what is missed, what the ledger says."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed import loop
from hilbed.clock import MILLISECOND, SECOND
from hilbed.pacer import Overrun, Paced, Pacer, RealtimeSpec
from tests.loop.clock import Wall
from tests.loop.fakes import rig

PERIOD = 10 * MILLISECOND


def pacer(wall: Wall, **spec: object) -> Pacer:
    return Pacer(RealtimeSpec.model_validate(spec), PERIOD, wall=wall.time())


def test_deadlines_are_absolute_so_that_sleeping_too_long_does_not_add_up() -> None:
    wall = Wall(over=70_000)
    one = pacer(wall)
    one.start(-SECOND)
    began = wall.now
    late = [one.wait(-SECOND + k * MILLISECOND) for k in range(1, 1001)]
    assert late == [70_000] * 1000
    assert wall.now == began + SECOND + 70_000


@given(st.lists(st.integers(0, 3 * PERIOD), min_size=1, max_size=50))
def test_a_cycle_is_missed_when_it_begins_later_than_half_a_period(work: list[int]) -> None:
    """The oracle is the recursion of lateness: what a cycle takes longer than its period is carried on."""
    wall = Wall()
    one = pacer(wall, give_up=10)
    one.start(0)
    late, expected, kept = 0, [], []
    for k, taken in enumerate(work):
        kept.append(one.due(k * PERIOD))
        expected.append(late)
        wall.now += taken
        late = max(0, late + taken - PERIOD)
    assert list(one.ledger.columns()["realtime/lateness"]) == pytest.approx([x / SECOND for x in expected])
    assert kept == [x <= PERIOD // 2 for x in expected]
    assert one.ledger.summary(PERIOD, {})["missed_deadlines"] == kept.count(False)


def test_after_an_overrun_the_schedule_is_where_it_was() -> None:
    wall = Wall()
    one = pacer(wall)
    one.start(0)
    began = wall.now
    assert one.due(0)
    wall.now += 34 * MILLISECOND
    assert [one.due(k * PERIOD) for k in range(1, 6)] == [False, False, True, True, True]
    assert wall.now == began + 5 * PERIOD


def test_a_tolerance_of_its_own() -> None:
    wall = Wall()
    one = pacer(wall, tolerance=0.02)
    one.start(0)
    wall.now += 20 * MILLISECOND
    assert one.due(0)
    wall.now += 1
    assert not one.due(0)


def test_the_policy_to_fail() -> None:
    wall = Wall()
    one = pacer(wall, overrun="fail")
    one.start(0)
    wall.now += 6 * MILLISECOND
    with pytest.raises(Overrun, match=r"0\.0060 s late"):
        one.due(0)
    assert list(one.ledger.columns()["realtime/missed"]) == [1]


def test_a_bench_that_stood_still_does_not_go_on() -> None:
    """As after a suspend: nobody wants the commands of a minute ago."""
    wall = Wall()
    one = pacer(wall)
    one.start(0)
    wall.now += 60 * SECOND
    with pytest.raises(Overrun, match="real time lost"):
        one.due(0)


class Medium:
    def __init__(self, wall: Wall) -> None:
        self.wall = wall
        self.calls: list[tuple[int, int]] = []

    def advance(self, until: int) -> None:
        self.calls.append((until, self.wall.now))


def test_a_paced_medium_runs_a_tick_and_then_waits_for_its_end_but_not_for_the_cycles() -> None:
    wall = Wall()
    one = pacer(wall)
    one.start(0)
    began = wall.now
    medium = Medium(wall)
    paced = Paced(medium, one)
    for k in range(1, 12):
        paced.advance(k * MILLISECOND)
    at = [(now - began) // MILLISECOND for _, now in medium.calls]
    assert [until // MILLISECOND for until, _ in medium.calls] == list(range(1, 12))
    assert at == [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9]
    assert one.cost.bus <= 0.0


def test_a_cycle_that_comes_too_late_thinks_and_moves_but_does_not_write() -> None:
    parts, world, _ = rig(10)
    cycles = list(loop.run(parts, 50, lambda t: t != 20))
    assert [cycle.t for cycle in cycles] == [0, 10, 20, 30, 40, 50]
    assert [t for who, t in world.diary if who == "write"] == [0, 10, 30, 40]
    assert [t for who, t in world.diary if who == "advance"] == [0, 10, 20, 30, 40]


def test_the_ledger_of_a_run() -> None:
    wall = Wall()
    one = pacer(wall)
    one.start(0)
    for k, late in enumerate([0, 40, 60, 7_000, 0]):
        wall.now = 5_000_000_000 + k * PERIOD + late * 1000
        one.due(k * PERIOD)
    summary = one.ledger.summary(PERIOD, {"left": 2, "right": 0})
    assert (summary["cycles"], summary["missed_deadlines"]) == (5, 1)
    assert summary["lateness"] == {
        "median": pytest.approx(40e-6),
        "p99": pytest.approx(7e-3),
        "worst": pytest.approx(7e-3),
        "worst_at": 0.03,
    }
    assert sum(summary["histogram"]["cycles"]) == 5
    assert summary["histogram"]["cycles"][:2] == [3, 1]
    assert summary["period"] == {
        "nominal": 0.01,
        "min": pytest.approx(0.003),
        "mean": pytest.approx(0.01),
        "max": pytest.approx(0.01694),
    }
    assert summary["late_answers"] == {"left": 2, "right": 0}


def test_a_ledger_without_cycles() -> None:
    assert pacer(Wall()).ledger.summary(PERIOD, {})["cycles"] == 0
