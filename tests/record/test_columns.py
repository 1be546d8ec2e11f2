from __future__ import annotations

from math import nan, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.poses import moved
from hilbed.record.columns import Columns
from hilbed.record.rounds import Rounds
from hilbed.record.row import Batch, DeadReckoning
from hilbed.types import Frame, Innovation, Odometry, Pose, Reading, Transfer
from tests.record.runs import FIELDS, PERIOD, cycle, play, ticks


def recorded(cycles: int = 301, **finish: object) -> dict[str, np.ndarray]:
    columns = Columns(("left", "right"), {"azimuth": 1})
    play([columns], cycles)
    return columns.finish(**finish)  # type: ignore[arg-type]


def test_shapes_and_values_are_those_of_the_contract() -> None:
    signals = recorded()
    assert signals["t"] == pytest.approx(np.arange(301) * 0.01)
    for name in ("truth", "estimate", "odometry", "reference"):
        assert signals[name].shape == (301, 3)
    assert signals["covariance"].shape == (301, 3, 3)
    assert signals["covariance"][7] == pytest.approx(np.diag([1.0, 4.0, 9.0]) + 0.1)
    assert signals["truth"][20] == pytest.approx([0.2, 2.0, 0.0])
    assert signals["estimate"][20] == pytest.approx([0.2, 0.2, 0.3])
    assert signals["reference"][20] == pytest.approx([0.2, 0.0, 0.0])
    assert signals["command"][3] == pytest.approx([0.5, -0.1])
    assert signals["drive/right/speed_measured"][10] == pytest.approx(14.9)
    assert signals["drive/left/current_measured"][10] == pytest.approx(5.0)
    assert signals["nis/t"] == pytest.approx(np.arange(31) * 0.1)
    assert signals["nis/accepted"].all()


def test_dead_reckoning_is_carried_on_from_the_counts_to_the_cycle() -> None:
    assert recorded()["odometry"][:, 0] == pytest.approx(np.arange(301) * 0.01)
    reckoning = DeadReckoning(Pose(1.0, 2.0, pi / 2))
    at = reckoning.at(30_000_000, Odometry(20_000_000, 0.5, 0.0, 2.0, 0.0))
    assert at == pytest.approx((1.0, 2.52, pi / 2))
    again = reckoning.at(40_000_000, Odometry(40_000_000, 0.0, 0.0, 2.0, 0.0))
    assert again == pytest.approx((1.0, 2.5, pi / 2)), "what was carried on must not be kept"


@given(st.floats(-1, 1), st.floats(0.01, 0.2), st.integers(1, 40))
def test_dead_reckoning_follows_a_circle_with_an_error_of_second_order(
    yaw: float, turn: float, steps: int
) -> None:
    pose = Pose(0.0, 0.0, yaw)
    for _ in range(steps):
        pose = moved(pose, turn, turn)  # radius 1 m
    angle = yaw + steps * turn
    exact = (np.sin(angle) - np.sin(yaw), np.cos(yaw) - np.cos(angle))
    assert pose[:2] == pytest.approx(exact, abs=steps * turn**3)


def test_drives_are_taken_from_the_tick_log_at_the_cycles() -> None:
    signals = recorded(ticks=ticks(3001))
    for number, field in enumerate(FIELDS):
        assert signals[f"drive/left/{field}"] == pytest.approx(number + np.arange(301) * 0.01)
    assert signals["tick/t"].shape == signals["tick/drive/right/duty"].shape == (3001,)


def test_an_aborted_run_has_what_there_was() -> None:
    signals = recorded(cycles=50, ticks=ticks(400))
    assert signals["t"].shape == (50,)
    assert np.isfinite(signals["drive/left/speed"][:40]).all()
    assert np.isnan(signals["drive/left/speed"][40:]).all()
    nothing = Columns(("left",), {"azimuth": 1}).finish()
    assert nothing["truth"].shape == (0, 3)
    assert nothing["azimuth/t"].shape == (0,)


def test_names_that_the_robot_lacks_are_absent() -> None:
    columns = Columns()
    play([columns], 3, boot=0)
    names = set(columns.finish())
    assert not [name for name in names if name.startswith(("drive/", "tick/", "range/"))]


def test_readings_are_in_order_of_delivery_and_only_delivered_ones_make_rows() -> None:
    from hilbed.cost import Cost
    from hilbed.record.journal import Journal
    from hilbed.record.notes import Notes

    columns = Columns()
    notes = Notes()
    journal = Journal(notes, [columns], Cost(), Pose(0.0, 0.0, 0.0))
    notes.reading(Reading("azimuth", 0, 3 * PERIOD, (0.3,), (0.1,)), 2, (0.31,))
    notes.reading(Reading("azimuth", 0, 1 * PERIOD, (0.1,), (0.1,)), -1, (nan,))
    notes.reading(Reading("position", 0, 1 * PERIOD, (1.0, 2.0), (0.1, 0.1)), -1, (nan,))
    notes.reading(Reading("azimuth", 0, 9 * PERIOD, (0.9,), (0.1,)), 1, (0.9,))
    for k in range(5):
        journal.record(cycle(k, innovations=(Innovation(0, 2.0, 2, False),)))
    journal.close()
    signals = columns.finish()
    assert signals["azimuth/measured"] == pytest.approx([0.1, 0.3])
    assert signals["azimuth/beacon"].tolist() == [-1, 2]
    assert np.isnan(signals["azimuth/true"][0])
    assert signals["azimuth/delivered"] == pytest.approx([0.01, 0.03])
    assert signals["position/measured"] == pytest.approx(np.array([[1.0, 2.0]]))
    assert signals["position/true"].shape == (1, 2)
    assert signals["nis/dof"].tolist() == [2] * 5


def test_what_a_frame_waits_is_the_bus_being_taken_and_then_arbitration() -> None:
    """Three frames queued while one is on the bus: the second of them loses once, the third twice."""
    ways = [(0, 0, 100), (40, 110, 200), (50, 210, 300), (60, 310, 400), (310, 410, 500)]
    transfers = [Transfer(*way, Frame(1), "left", error=k == 1) for k, way in enumerate(ways)]
    columns = Columns()
    columns.take(Batch((), transfers, (), (), ()))
    signals = columns.finish()
    assert signals["bus/arbitration"] * 1e9 == pytest.approx([0, 0, 100, 200, 100])
    assert signals["bus/error"].tolist() == [0, 1, 0, 0, 0]
    rounds = Rounds()
    split = [*rounds.lost(transfers[:2]), *rounds.lost([]), *rounds.lost(transfers[2:])]
    assert split == pytest.approx(signals["bus/arbitration"])


def test_bus_rows_hold_latency_and_duration() -> None:
    signals = recorded(cycles=2)
    assert signals["bus/t"].shape == (7,)
    assert signals["bus/latency"] == pytest.approx(np.full(7, 234e-6))
    assert signals["bus/duration"] == pytest.approx(np.full(7, 224e-6))
    assert signals["bus/id"].tolist() == [0x700, 0x701, 0x702, 0x80, 0x181, 0x80, 0x181]
