"""The control cycle with fakes behind every seam: order, times, number and causality of what happens."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed import loop
from tests.loop.fakes import World, rig


@given(st.integers(0, 30), st.integers(1, 50))
def test_a_run_has_one_cycle_more_than_periods_and_the_last_moves_nothing(periods: int, period: int) -> None:
    parts, world, _ = rig(period)
    cycles = list(loop.run(parts, periods * period))
    assert [cycle.t for cycle in cycles] == [k * period for k in range(periods + 1)]
    assert [cycle.truth.t for cycle in cycles] == [cycle.t for cycle in cycles]
    assert world.now == periods * period
    for moves in ("advance", "write"):
        assert [t for who, t in world.diary if who == moves] == [k * period for k in range(periods)]


def test_a_cycle_reads_thinks_writes_and_only_then_moves() -> None:
    parts, world, _ = rig()
    cycle = loop.cycle(parts, 0)
    order = ["truth", "odometry", "readings", "estimate", "command", "write", "advance"]
    assert [who for who, _ in world.diary] == order
    assert {t for _, t in world.diary} == {0}
    assert cycle.command.v == world.v


def test_thinking_alone_changes_nothing_of_the_world() -> None:
    parts, world, _ = rig()
    loop.cycle(parts, 0)
    before = world.now, world.x, world.v
    loop.think(parts, 10)
    assert (world.now, world.x, world.v) == before


def test_the_controller_sees_what_was_known_at_the_start_of_its_period() -> None:
    """Half of what is left in each period: x(k+1) = x(k) + (1 − x(k)) / 2."""
    parts, world, _ = rig()
    cycles = list(loop.run(parts, 50))
    assert [cycle.truth.pose.x for cycle in cycles] == pytest.approx([1 - 0.5**k for k in range(6)])
    assert [float(cycle.estimate.mean[0]) for cycle in cycles] == pytest.approx(
        [1 - 0.5**k for k in range(6)]
    )
    assert world.x == cycles[-1].truth.pose.x


@given(st.integers(1, 100), st.integers(0, 100))
def test_readings_come_to_the_estimator_once_in_order_and_not_before_their_time(rate: int, late: int) -> None:
    parts, world, estimator = rig(world=World(rate, late))
    cycles = list(loop.run(parts, 500))
    assert all(reading.delivered <= t < reading.delivered + 10 for t, reading in estimator.heard)
    stamps = [reading.t for _, reading in estimator.heard]
    assert stamps == sorted(set(stamps))
    assert [reading for cycle in cycles for reading in cycle.readings] == [r for _, r in estimator.heard]
    assert len(stamps) + len(world.sent) > 0


def test_cycles_come_one_at_a_time_so_that_a_run_can_be_left() -> None:
    parts, world, _ = rig()
    cycles = loop.run(parts, 1000)
    next(cycles)
    next(cycles)
    cycles.close()
    assert world.now == 20


def test_what_a_part_throws_is_not_swallowed() -> None:
    parts, world, _ = rig()
    world.now = 7  # so that its own check fails
    with pytest.raises(AssertionError):
        loop.cycle(parts, 0)


def test_its_time_is_accounted_for() -> None:
    parts, _, _ = rig()
    list(loop.run(parts, 1000))
    assert min(parts.cost.bus, parts.cost.estimator, parts.cost.controller) > 0.0
    assert parts.cost.physics == parts.cost.render == 0.0
