"""Ticks against a clock that the test moves."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from hilbed.drive.metronome import BURST, STALL, Metronome

PERIOD = 1_000_000


def run(metronome: Metronome, now: int) -> int:
    """Runs what is due and returns how many ticks that were."""
    count = metronome.due(now)
    for _ in range(count):
        metronome.ran()
    return count


@given(st.integers(-(10**15), 10**15), st.integers(0, PERIOD - 1), st.integers(1, 100))
def test_in_time_it_ticks_once_a_period(start: int, late: int, count: int) -> None:
    metronome = Metronome(start, PERIOD)
    assert metronome.due(start - 1) == 0
    assert [run(metronome, start + k * PERIOD + late) for k in range(count)] == [1] * count
    assert (metronome.ticks, metronome.dropped, metronome.worst) == (count, 0, late)


@given(st.lists(st.integers(0, 2 * STALL), max_size=60))
def test_whatever_the_clock_does(steps: list[int]) -> None:
    metronome, now = Metronome(0, PERIOD), 0
    ran = 0
    for step in steps:
        now += step
        count = run(metronome, now)
        ran += count
        assert count <= BURST
        # Never ahead of the clock; every tick has either run or been dropped.
        assert metronome.ticks <= now // PERIOD + 1
        assert metronome.ticks == ran + metronome.dropped
    for _ in range(STALL // PERIOD):  # left alone, it is in time again
        run(metronome, now)
    assert metronome.ticks == now // PERIOD + 1


@given(st.integers(1, STALL // PERIOD))
def test_a_hitch_is_made_up_for_in_bursts(hitch: int) -> None:
    metronome = Metronome(0, PERIOD)
    now = hitch * PERIOD
    bursts = []
    while count := run(metronome, now):
        bursts.append(count)
    assert sum(bursts) == hitch + 1
    assert metronome.dropped == 0


@given(st.integers(STALL + 1, 10**13))
def test_after_a_stall_time_has_passed_without_ticks(stall: int) -> None:
    metronome = Metronome(0, PERIOD)
    assert run(metronome, stall) == 1
    assert metronome.ticks == stall // PERIOD + 1
    assert metronome.dropped == stall // PERIOD
