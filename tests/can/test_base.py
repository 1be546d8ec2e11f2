"""The controller's base in operation: firmware drives, silence, faults, garbage."""

from __future__ import annotations

from math import isnan, nan, tau

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hilbed.can.specs import BusSpec, NodeSpec
from hilbed.clock import MILLISECOND
from hilbed.types import BusError, Command, Diverged, DriveSignals, Frame
from tests.can.rig import COUNTS, PERIOD, TwoDrives


def booted(bus: BusSpec | None = None) -> TwoDrives:
    bench = TwoDrives(bus=bus)
    bench.boot()
    bench.transfers.clear()
    return bench


def test_the_first_reading_knows_nothing_yet() -> None:
    bench = TwoDrives()
    odometry = bench.base.read(0)
    assert odometry[:5] == (0, 0.0, 0.0, 0.0, 0.0)
    signals = odometry.drives["left"]
    assert signals.speed_ref == 0.0
    assert isnan(signals.speed_measured)
    assert isnan(signals.current_measured)


def test_a_hundred_cycles() -> None:
    bench = booted()
    command = Command(0.5, 0.3)
    distance = turn = 0.0
    for cycle in range(100):
        odometry = bench.cycle(cycle * PERIOD, command)
        distance, turn = distance + odometry.distance, turn + odometry.turn
    assert odometry.t == 98 * PERIOD
    assert (odometry.v, odometry.w) == pytest.approx((0.5, 0.3), abs=0.02)
    assert odometry.drives["left"].speed_ref == bench.robot.wheel_speeds(command)[0]
    assert odometry.drives["right"].current_measured == pytest.approx(0.5, abs=0.5 * 3.36 / 1000)
    odometry = bench.base.read(100 * PERIOD)
    sampled = [shaft.angle - shaft.speed * 0.01 for shaft in bench.shafts]
    expected = bench.robot.travel(sampled)
    assert distance + odometry.distance == pytest.approx(expected[0], abs=1e-3)
    assert turn + odometry.turn == pytest.approx(expected[1], abs=1e-3)
    assert bench.base.ears.events == []
    assert bench.base.ears.ignored == 0


def test_odometry_is_exactly_that_of_the_counts_on_the_bus() -> None:
    bench = booted()
    distance = turn = 0.0
    for cycle in range(50):
        odometry = bench.cycle(cycle * PERIOD, Command(0.3, -0.5))
        distance, turn = distance + odometry.distance, turn + odometry.turn
    counts = {1: list[int](), 2: list[int]()}
    for transfer in bench.transfers:
        if transfer.frame.id & 0x780 == 0x280 and transfer.end < 490 * MILLISECOND:
            position = int.from_bytes(transfer.frame.data[:4], "little", signed=True)
            counts[transfer.frame.id & 0x7F].append(position)
    turned = [(counts[n][-1] - counts[n][0]) * tau / COUNTS for n in (1, 2)]
    assert (distance, turn) == pytest.approx(bench.robot.travel(turned), abs=1e-12)


def test_a_cycle_starts_with_sync_and_targets_act_at_the_next() -> None:
    bench = booted()
    bench.cycle(0, Command(0.5, 0.0))
    assert bench.transfers[0].frame == Frame(0x80)
    assert [s.frame.id for s in bench.transfers if s.node == "controller"] == [0x80, 0x201, 0x202, 0x77F]
    assert all(shaft.drive.speed_ref == 0 for shaft in bench.shafts)
    bench.cycle(PERIOD, Command(0.5, 0.0))
    counts = 5.0 * COUNTS / tau
    assert [s.drive.speed_ref for s in bench.shafts] == pytest.approx([round(counts) * tau / COUNTS] * 2)


def replay(bench: TwoDrives, t: int, *frames: Frame) -> None:
    for frame in frames:
        bench.stranger.send(t, frame)
    bench.wire.advance(t + PERIOD)


def position(node: int, counts: int) -> Frame:
    return Frame(0x280 + node, counts.to_bytes(4, "little", signed=True) + bytes(2))


def unpowered() -> TwoDrives:
    """A base whose drives are the stranger's frames."""
    bench = TwoDrives(powered=0, bus=BusSpec(silent="hold"))
    bench.wire.advance(0)
    return bench


@given(st.integers(-(2**31), 2**31 - 1), st.integers(-(2**30), 2**30))
def test_positions_may_wrap(start: int, step: int) -> None:
    bench = unpowered()
    after = (start + step + 2**31) % 2**32 - 2**31
    bench.base.write(0, Command(0, 0))
    replay(bench, 0, position(1, start), position(2, start))
    assert bench.base.read(PERIOD)[:3] == (0, 0.0, 0.0)
    bench.base.write(PERIOD, Command(0, 0))
    replay(bench, PERIOD, position(1, after), position(2, after))
    odometry = bench.base.read(2 * PERIOD)
    assert odometry.t == PERIOD
    assert odometry.distance == pytest.approx(0.1 * step * tau / COUNTS, abs=1e-9)
    assert odometry.turn == 0.0


def test_an_incomplete_set_moves_nothing_and_the_next_one_all() -> None:
    bench = unpowered()
    for cycle, frames in enumerate(
        [
            (position(1, 0), position(2, 0)),
            (position(1, 660),),
            (position(1, 1320), position(2, 1320)),
        ]
    ):
        t = cycle * PERIOD
        bench.base.write(t, Command(0, 0))
        replay(bench, t, *frames)
        odometry = bench.base.read(t + PERIOD)
        expected = [(0, 0.0), (0, 0.0), (2 * PERIOD, 0.1 * 0.02 * tau)][cycle]
        assert odometry[:2] == pytest.approx(expected)


def test_speed_and_current_are_those_of_the_table() -> None:
    bench = unpowered()
    bench.base.write(0, Command(0, 0))
    speed = round(5.0 * COUNTS / tau)
    data = (0x0637).to_bytes(2, "little") + speed.to_bytes(4, "little") + bytes(2)
    replay(
        bench, 0, Frame(0x181, data), Frame(0x182, data), Frame(0x281, bytes(4) + (250).to_bytes(2, "little"))
    )
    odometry = bench.base.read(PERIOD)
    assert odometry.drives["left"] == DriveSignals(0.0, speed * tau / COUNTS, 0.84)
    assert (odometry.v, odometry.w) == pytest.approx((0.5, 0.0), abs=1e-4)


def test_the_stop_holds_against_targets_that_are_still_waiting() -> None:
    bench = booted()
    for cycle in range(60):
        bench.cycle(cycle * PERIOD, Command(0.5, 0.0))
    assert bench.shafts[0].speed > 4.0
    bench.base.stop(60 * PERIOD)
    for cycle in range(60, 120):
        bench.cycle(cycle * PERIOD, Command(0.5, 0.0))
    assert all(abs(shaft.speed) < 0.05 for shaft in bench.shafts)


def test_a_controller_that_dies_leaves_no_moving_robot() -> None:
    bench = booted()
    t = 0
    for _ in range(60):
        bench.cycle(t, Command(0.5, 0.0))
        t += PERIOD
    for _ in range(600):
        t = bench.pump(t)
    assert all(abs(shaft.speed) < 0.05 for shaft in bench.shafts)


def silence(bench: TwoDrives, cycles: int) -> None:
    for cycle in range(cycles):
        bench.shafts[1].powered = cycle < 20
        bench.cycle(cycle * PERIOD, Command(0.5, 0.0))


def test_silence_fails_the_run() -> None:
    with pytest.raises(BusError, match=r"drive right \(node 2\) has been silent since 0.19"):
        silence(booted(BusSpec(silent="fail", silent_after=0.05)), 40)


def test_silence_is_held_out() -> None:
    bench = booted(BusSpec(silent="hold", silent_after=0.05))
    silence(bench, 40)
    assert bench.base.silences == 1
    assert bench.base.silent == ("right",)
    assert bench.shafts[0].speed > 4.0


def test_a_short_silence_ends() -> None:
    bench = booted(BusSpec(silent="hold", silent_after=0.02))
    silence(bench, 23)
    assert bench.base.silences == 1
    bench.shafts[1].powered = True
    for cycle in range(23, 26):
        bench.cycle(cycle * PERIOD, Command(0.5, 0.0))
    assert len(bench.base.silent) == 0
    said = [(event.drive, event.text[:15]) for event in bench.base.ears.events]
    assert said == [("right", "silent since 0."), ("right", "answers again")]


def test_silence_stops_all_drives() -> None:
    bench = booted(BusSpec(silent="quick_stop", silent_after=0.05))
    silence(bench, 80)
    assert abs(bench.shafts[0].speed) < 0.05


def test_a_long_period_is_no_silence() -> None:
    base = TwoDrives(powered=0, bus=BusSpec(silent="fail", silent_after=0.05)).base
    base.write(0, Command(0, 0))
    base.read(1000 * MILLISECOND)
    assert base.silences == 0
    base.write(1000 * MILLISECOND, Command(0, 0))
    with pytest.raises(BusError, match="silent"):
        base.read(2000 * MILLISECOND)


def test_a_fault_is_reported() -> None:
    bench = booted()
    for cycle in range(20):
        if cycle == 10:
            bench.shafts[0].current = 30_000
        bench.cycle(cycle * PERIOD, Command(0.5, 0.0))
    assert bench.base.faulted == ("left",)
    said = [event.text for event in bench.base.ears.events]
    assert any(text.startswith("emergency 2") for text in said)
    assert any(text.startswith("fault (statusword") for text in said)


def test_a_real_drive_that_stops_by_itself_ends_the_run() -> None:
    bench = TwoDrives(nodes={"left": NodeSpec(kind="real")})
    bench.boot()
    bench.shafts[0].current = 30_000
    bench.cycle(0, Command(0.2, 0.0))
    with pytest.raises(BusError, match=r"left \(node 1\) has stopped by itself: fault.*emergency 2"):
        bench.base.read(PERIOD)


def test_a_real_drive_that_is_told_to_stop_is_no_surprise() -> None:
    bench = TwoDrives(nodes={"left": NodeSpec(kind="real")})
    bench.boot()
    bench.cycle(0, Command(0.2, 0.0))
    bench.base.stop(PERIOD)
    for cycle in range(1, 60):
        bench.cycle(cycle * PERIOD, Command(0.2, 0.0))
    assert "left" not in bench.base.moving


def test_a_drive_that_restarts_is_noticed() -> None:
    bench = booted()
    bench.cycle(0, Command(0, 0))
    bench.stranger.send(PERIOD, Frame(0, bytes((0x81, 2))))
    bench.cycle(PERIOD, Command(0, 0))
    bench.base.read(2 * PERIOD)
    assert [e.drive for e in bench.base.ears.events if "boot-up" in e.text] == ["right"]


@pytest.mark.parametrize("command", [Command(nan, 0.0), Command(0.0, float("inf"))])
def test_a_command_that_is_no_number(command: Command) -> None:
    with pytest.raises(Diverged, match="the controller asked for"):
        booted().base.write(0, command)


def test_a_target_beyond_the_object_is_limited() -> None:
    bench = unpowered()
    bench.base.write(0, Command(1e12, 0.0))
    bench.wire.advance(PERIOD)
    (target,) = [transfer.frame for transfer in bench.transfers if transfer.frame.id == 0x201]
    assert target.data[2:] == (2**31 - 1).to_bytes(4, "little")


identifiers = st.integers(0, 2047) | st.sampled_from(
    [0x80, 0x81, 0x82, 0x181, 0x182, 0x281, 0x282, 0x381, 0x581, 0x701, 0x702]
)
garbage = st.lists(
    st.builds(Frame, identifiers, st.binary(max_size=8), st.booleans(), st.booleans()), max_size=12
)


@settings(deadline=None, max_examples=150)
@given(st.lists(garbage, min_size=1, max_size=5))
def test_frames_of_any_content_never_raise(cycles: list[list[Frame]]) -> None:
    bench = unpowered()
    for cycle, frames in enumerate(cycles):
        bench.base.write(cycle * PERIOD, Command(0.1, 0.1))
        replay(bench, cycle * PERIOD, *frames)
        odometry = bench.base.read((cycle + 1) * PERIOD)
        assert not any(map(isnan, odometry[1:5]))


@settings(deadline=None, max_examples=30)
@given(garbage)
def test_garbage_beside_real_drives_never_raises(frames: list[Frame]) -> None:
    bench = booted(BusSpec(silent="hold"))
    for frame in frames:
        bench.stranger.send(0, frame)
    for cycle in range(3):
        bench.cycle(cycle * PERIOD, Command(0.1, 0.1))
