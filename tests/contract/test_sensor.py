"""What every Sensor does: readings once, oldest first, never before their time, whoever asks how often."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hilbed.plant.recorded import Recorded
from hilbed.plant.recorded_spec import RecordedSpec
from hilbed.plant.recording import load
from hilbed.plant.replay import RecordedSensor
from hilbed.ports import Sensor
from hilbed.types import Nanos, Pose, Reading, Truth
from tests.recorded.files import write
from tests.recorded.test_replay import Notes
from tests.sensors.cameras import Bench
from tests.sensors.direct import Rig

MS: Nanos = 1_000_000
END = 1500 * MS
Make = Callable[[Path], Sensor]


def camera(**block: object) -> Make:
    return lambda _: Bench({"kind": "camera", **block}).camera


def direct(**block: object) -> Make:
    return lambda _: Rig(block).sensor


def recorded(kind: str) -> Make:
    def make(folder: Path) -> Sensor:
        spec = RecordedSpec(kind="recorded", file="robot.npz", range=True)
        return RecordedSensor(Recorded(spec, load(write(folder))), kind, Notes())

    return make


SENSORS: dict[str, Make] = {
    "camera": camera(),
    "camera, late and lossy": camera(latency=0.25, loss=0.4, rate=13.0, noise=0.01, missed=0.2),
    "camera, at once": camera(latency=0.0, rate=100.0, pan={"kind": "scanning", "rate": 2.0}),
    "camera, false": camera(spurious=2.0, pan={"kind": "tracking"}),
    "position": direct(kind="position"),
    "position, hidden at times": direct(kind="position", rate=50.0, front=0.1, dropouts=1.0, loss=0.1),
    "pose, late": direct(kind="position", yaw_noise=0.02, latency=0.21, rate=17.0),
    "bearing": direct(kind="bearing"),
    "bearing, at once": direct(kind="bearing", noise=0.01, latency=0.0, max_range=3.0, rate=40.0),
    "range and bearing": direct(kind="range_bearing"),
    "recorded azimuth": recorded("azimuth"),
    "recorded range": recorded("range"),
}


def played(sensor: Sensor, polls: list[Nanos]) -> list[list[Reading]]:
    """Moves time tick by tick, samples as a plant does, and returns what each poll has brought."""
    found, due = [], set(polls)
    for now in range(0, END + MS, MS):
        if sensor.due <= now:
            before = sensor.due
            sensor.sample(Truth(now, Pose(0.1, -0.1, 1e-9 * now)))
            assert sensor.due > max(before, now), "or the plant would never go on"
        if now in due:
            found.append(sensor.read(now))
            assert sensor.read(now) == [], "each reading once"
    return found


@pytest.mark.parametrize("name", SENSORS)
@settings(max_examples=8, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.integers(0, END // MS), max_size=20, unique=True))
def test_readings_come_in_order_at_their_time_and_do_not_depend_on_who_asks_how_often(
    tmp_path: Path, name: str, some: list[int]
) -> None:
    polls = [k * MS for k in sorted({*some, END // MS})]
    batches = played(SENSORS[name](tmp_path), polls)
    for poll, batch in zip(polls, batches, strict=True):
        assert all(reading.t <= reading.delivered <= poll for reading in batch)
    readings = [reading for batch in batches for reading in batch]
    stamps = [(reading.delivered, reading.t) for reading in readings]
    assert stamps == sorted(stamps)
    assert len(readings) > 5
    (all_at_once,) = played(SENSORS[name](tmp_path), [END])
    assert readings == all_at_once


@pytest.mark.parametrize("name", SENSORS)
def test_a_reading_is_whole(tmp_path: Path, name: str) -> None:
    (readings,) = played(SENSORS[name](tmp_path), [END])
    for reading in readings:
        assert len(reading.value) == len(reading.std)
        assert all(std > 0.0 for std in reading.std)
        assert reading.kind in ("azimuth", "range", "position", "pose", "front")
        assert reading.kind != "azimuth" or -3.15 < reading.value[0] < 3.15
