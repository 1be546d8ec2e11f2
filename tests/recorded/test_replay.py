from __future__ import annotations

from math import isnan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hilbed.plant.recorded import Recorded
from hilbed.plant.recorded_spec import RecordedSpec
from hilbed.plant.recording import load
from hilbed.plant.replay import RecordedBase, RecordedPlant, RecordedSensor
from hilbed.types import Command, Reading, ScenarioError, Snapshot, Transfer
from tests.estimation.experiment import sight
from tests.recorded.files import arrays, write

STEP = 100_000_000


class Notes:
    def __init__(self) -> None:
        self.readings: list[tuple[Reading, int, tuple[float, ...]]] = []

    def reading(self, reading: Reading, beacon: int, true: tuple[float, ...]) -> None:
        self.readings.append((reading, beacon, true))

    def snapshot(self, snapshot: Snapshot) -> None: ...

    def transfer(self, transfer: Transfer) -> None: ...


def played(folder: Path, changes: dict[str, Any] | None = None, **spec: Any) -> Recorded:
    return Recorded(
        RecordedSpec(kind="recorded", file="robot.npz", **spec), load(write(folder, **(changes or {})))
    )


def test_odometry_holds_each_speed_to_the_next_row(tmp_path: Path) -> None:
    base, table = RecordedBase(played(tmp_path)), arrays()
    first = base.read(0)
    assert (first.t, first.distance, first.turn) == (0, 0.0, 0.0)
    base.write(0, Command(1.0, 1.0))
    odometry = base.read(3 * STEP)
    assert odometry.t == 3 * STEP
    assert odometry.distance == pytest.approx(table["v"][:3].sum() * 0.1)
    assert odometry.turn == pytest.approx(table["omega"][:3].sum() * 0.1)
    assert (odometry.v, odometry.w) == (table["v"][3], table["omega"][3])


def test_no_way_is_lost_or_told_twice_at_any_period(tmp_path: Path) -> None:
    for period in (10_000_000, 70_000_000, STEP, 250_000_000):
        base = RecordedBase(played(tmp_path))
        told = [base.read(t) for t in range(0, 2_000_000_000, period)]
        assert sum(o.distance for o in told) == pytest.approx(arrays()["v"][:9].sum() * 0.1)
        assert told[-1].t == 9 * STEP


def test_readings_come_once_at_their_times_with_their_true_values(tmp_path: Path) -> None:
    notes = Notes()
    sensor = RecordedSensor(played(tmp_path), "azimuth", notes)
    assert [r.beacon for r in sensor.read(0)] == [0, 1]
    assert sensor.read(0) == []
    late = sensor.read(2 * STEP + 1)
    assert [(r.t, r.delivered) for r in late] == [(STEP, STEP)] * 2 + [(2 * STEP, 2 * STEP)] * 2
    assert late[1].value[0] == pytest.approx(3.3 - 2 * np.pi), "azimuths are wrapped"
    assert late[0].std == (0.02,)
    truth = played(tmp_path).poses[2]
    _, beacon, (true,) = notes.readings[-1]
    assert true == pytest.approx(sight(truth, (-2.0, 0.5), (0.2, 0.0))[0])
    assert beacon == 1
    sensor.read(3 * STEP)
    assert isnan(notes.readings[-1][2][0]), "no truth, no true azimuth"


def test_ranges_and_how_far_is_too_far(tmp_path: Path) -> None:
    (reading,) = RecordedSensor(played(tmp_path, azimuth=False, range=True), "range", Notes()).read(0)
    assert (reading.kind, reading.beacon, reading.std) == ("range", 0, (0.03,))
    near = played(tmp_path, range=True, max_range=1.0)
    assert RecordedSensor(near, "range", Notes()).read(10 * STEP) == []
    assert RecordedSensor(near, "azimuth", Notes()).read(10 * STEP) == []


def test_anonymous_readings_keep_their_identity_for_the_record(tmp_path: Path) -> None:
    notes = Notes()
    readings = RecordedSensor(played(tmp_path, anonymous=True), "azimuth", notes).read(0)
    assert [r.beacon for r in readings] == [None, None]
    assert [beacon for _, beacon, _ in notes.readings] == [0, 1]


def test_truth_is_the_file_s_and_between_rows_a_line_the_short_way_round(tmp_path: Path) -> None:
    plant = RecordedPlant(played(tmp_path))
    assert plant.truth().pose == pytest.approx((0.0, 0.0, 3.0))
    plant.advance(0, 7 * STEP // 2)
    assert isnan(plant.truth().pose.x), "a neighbour is not known"
    plant.advance(0, 17 * STEP // 2)
    yaw = 3.0 + 0.4 * 8.5 / 9 - 2 * np.pi
    assert plant.truth().pose == pytest.approx((0.85, 0.0, yaw))
    plant.advance(0, 20 * STEP)
    assert isnan(plant.truth().pose.x)


def test_a_part_starts_at_its_first_row(tmp_path: Path) -> None:
    part = played(tmp_path, start=0.35, length=0.4)
    assert part.times == [0, STEP, 2 * STEP, 3 * STEP]
    assert part.start == pytest.approx(tuple(arrays()["truth"][4] - [0, 0, 0]))
    assert part.duration == pytest.approx(0.3)
    assert part.v == pytest.approx(arrays()["v"][4:8])


@pytest.mark.parametrize(
    ("changes", "spec", "words"),
    [
        ({}, {"start": 5.0}, "leaves nothing"),
        ({}, {"start": 0.3}, "true pose at the start is not known"),
        ({"truth": None, "truth_valid": None}, {}, "true pose at the start is not known"),
        ({"range": None}, {"range": True}, "no range in this file"),
        ({"bearing": None}, {}, "no bearing in this file"),
        ({"bearing_variance": None}, {}, "give azimuth_std"),
    ],
)
def test_what_the_file_lacks_is_told(
    tmp_path: Path, changes: dict[str, Any], spec: dict[str, Any], words: str
) -> None:
    with pytest.raises(ScenarioError, match=words):
        played(tmp_path, changes, **spec)


def test_a_told_pose_and_std_stand_in(tmp_path: Path) -> None:
    gone = dict.fromkeys(("truth", "truth_valid", "bearing_variance"))
    part = played(tmp_path, gone, pose=(1.0, 2.0, 0.5), azimuth_std=0.05)
    assert part.start == (1.0, 2.0, 0.5)
    assert part.std("azimuth") == 0.05
