"""Sensors of position and of landmarks: what they read, what is wrong with it, what the witness hears."""

from __future__ import annotations

from cmath import phase, rect
from math import atan2, hypot, isnan, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from hilbed.scene import BeaconSpec
from hilbed.types import Pose
from tests.sensors.direct import BEACONS, NAME, SPEC, Rig

places = st.floats(-10, 10)
poses = st.builds(Pose, places, places, st.floats(-pi, pi))
HERE = Pose(0.5, -0.25, 0.75)
BLOCKS = [
    {"kind": "position"}, {"kind": "position", "yaw_noise": 0.1, "front": 0.2},
    {"kind": "bearing", "noise": 0.1}, {"kind": "range_bearing"},
]  # fmt: skip


@given(poses, places, places)
def test_bearings_and_ranges_are_those_of_the_plane(pose: Pose, forward: float, left: float) -> None:
    """By complex numbers: a landmark seen from the mount, turned back by the yaw."""
    block = {"mount": (forward, left), "range_noise": 0.0, "bearing_noise": 0.0}
    readings = Rig({"kind": "range_bearing", **block}).sampled(pose)
    heading = rect(1.0, pose.yaw)
    eye = complex(pose.x, pose.y) + complex(forward, left) * heading
    for reading in readings:
        assert reading.beacon is not None
        seen = (complex(*BEACONS[reading.beacon].at) - eye) / heading
        if reading.kind == "range":
            assert reading.value[0] == pytest.approx(abs(seen), abs=1e-12)
        else:
            left_over = seen * rect(1.0, -reading.value[0])
            turn = atan2(left_over.imag, left_over.real)  # cmath.phase overflows at subnormal numbers
            assert abs(turn) * abs(seen) < 1e-9
    assert len(readings) == 2 * sum(abs(complex(*beacon.at) - eye) >= 1e-3 for beacon in BEACONS)


def test_a_landmark_that_is_touched_or_too_far_is_not_seen() -> None:
    beacons = tuple(BeaconSpec(at=(x, 0.0)) for x in (0.0, 1.0, 2.0, 3.0))
    rig = Rig({"kind": "bearing", "max_range": 2.0}, beacons)
    assert [reading.beacon for reading in rig.sampled(Pose(0.0, 0.0, 0.0))] == [1, 2]


def test_a_range_is_never_negative() -> None:
    rig = Rig({"kind": "range_bearing", "range_noise": 10.0})
    ranges = [reading.value[0] for reading in rig.sampled(HERE, 200) if reading.kind == "range"]
    assert min(ranges) == 0.0
    assert max(ranges) > 10.0


def test_positions_scatter_as_told_round_the_truth() -> None:
    rig = Rig({"kind": "position", "noise": 0.1, "yaw_noise": 0.02})
    values = np.array([reading.value for reading in rig.sampled(HERE, 4000)])
    np.testing.assert_allclose(values.mean(axis=0), HERE, atol=0.006)
    np.testing.assert_allclose(values.std(axis=0), (0.1, 0.1, 0.02), rtol=0.05)
    np.testing.assert_allclose(np.corrcoef(values.T), np.eye(3), atol=0.06)
    assert {true for _, _, true in rig.ear.heard} == {tuple(HERE)}


@given(poses, st.floats(0.01, 1.0))
def test_the_second_marker_is_ahead_of_the_axle(pose: Pose, ahead: float) -> None:
    axle, marker = Rig({"kind": "position", "noise": 0.0, "front": ahead}).sampled(pose)
    assert (axle.kind, marker.kind) == ("position", "front")
    dx, dy = marker.value[0] - axle.value[0], marker.value[1] - axle.value[1]
    assert hypot(dx, dy) == pytest.approx(ahead)
    assert phase(complex(dx, dy) * rect(1.0, -pose.yaw)) == pytest.approx(0.0, abs=1e-9)


def test_a_measured_yaw_stays_an_angle() -> None:
    rig = Rig({"kind": "position", "yaw_noise": 0.5})
    yaws = [reading.value[2] for reading in rig.sampled(Pose(0.0, 0.0, pi), 100)]
    assert max(yaws) <= pi
    assert min(yaws) < -2.5, "or none went over the edge"


@pytest.mark.parametrize("block", BLOCKS)
def test_the_block_says_what_is_measured_and_the_witness_hears_it_all(block: dict[str, object]) -> None:
    rig = Rig(block)
    readings = rig.sampled(HERE, 3)
    assert {reading.kind: len(reading.value) for reading in readings} == rig.spec.kinds()
    assert [reading for reading, _, _ in rig.ear.heard] == readings
    for reading, beacon, true in rig.ear.heard:
        assert len(true) == len(reading.value)
        assert beacon == (-1 if reading.beacon is None else reading.beacon)


def test_without_noise_a_reading_claims_a_millionth() -> None:
    (reading,) = Rig({"kind": "position", "noise": 0.0}).sampled(HERE)
    assert (reading.value, reading.std) == (HERE[:2], (1e-6, 1e-6))


@pytest.mark.parametrize("block", BLOCKS)
def test_a_lost_sensor_is_silent_and_goes_on_afterwards(block: dict[str, object]) -> None:
    rig = Rig(block)
    rig.effects.lost.add(NAME)
    assert not rig.sampled(HERE, 3)
    assert not rig.ear.heard
    rig.effects.reset()
    (first, *_) = rig.sampled(HERE)
    assert first.t == 300_000_000, "its clock has run on"


@pytest.mark.parametrize("block", BLOCKS)
def test_a_broken_sensor_delivers_nan_on_time_and_tells_the_witness_the_truth(
    block: dict[str, object],
) -> None:
    whole, rig = Rig(block).sampled(HERE), Rig(block)
    rig.effects.broken.add(NAME)
    for reading, before in zip(rig.sampled(HERE), whole, strict=True):
        assert all(map(isnan, reading.value))
        assert reading._replace(value=()) == before._replace(value=())
    assert all(np.isfinite(true).all() for _, _, true in rig.ear.heard)


def test_only_the_sensor_that_is_named_is_disturbed() -> None:
    rig = Rig({"kind": "position"})
    rig.effects.lost.add("another")
    rig.effects.broken.add("another")
    (reading,) = rig.sampled(HERE)
    assert np.isfinite(reading.value).all()


def test_dropouts_take_their_share_and_come_in_one_piece() -> None:
    """Every two seconds in sight, half a second long: a fifth of the time, in gaps of 50 samples."""
    rig = Rig({"kind": "position", "rate": 100.0, "dropouts": 0.5, "dropout_length": 0.5})
    times = np.array([reading.t for reading in rig.sampled(HERE, 100_000)]) * 1e-9
    assert len(times) / 100_000 == pytest.approx(0.8, abs=0.03)
    gaps = np.diff(times)
    assert gaps[gaps > 0.015].mean() == pytest.approx(0.51, rel=0.15)


@pytest.mark.parametrize(
    "block",
    [
        {"kind": "position", "noise": -0.1}, {"kind": "position", "front": 0.0},
        {"kind": "position", "yaw_noise": 4.0}, {"kind": "bearing", "noise": float("nan")},
        {"kind": "bearing", "max_range": -1.0}, {"kind": "range_bearing", "noise": 0.1},
        {"kind": "position", "dropouts": 1e6}, {"kind": "position", "dropout_length": 0.0},
    ],
)  # fmt: skip
def test_a_sensor_that_cannot_be_is_refused(block: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        SPEC.validate_python(block)
