from __future__ import annotations

import subprocess
import sys
from math import atan2, cos, isnan, pi, sin

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from pydantic import ValidationError

from hilbed.angles import wrap
from hilbed.scene import BeaconSpec
from hilbed.sensors.camera import CameraSpec
from hilbed.types import Pose, Truth
from tests.sensors.cameras import BEACONS, EXPOSURE, Bench

POSE = Pose(0.5, -0.3, 2.0)


def test_a_reading_carries_exposure_delivery_identity_and_azimuth_in_the_robots_frame() -> None:
    bench = Bench(
        {"latency": 0.03, "pan": {"kind": "fixed", "angle": 2.0}, "mount": [0.2, 0.1, 0.4]}, rendered=True
    )
    bench.camera.sample(Truth(0, POSE))
    assert bench.camera.read(29_999_999) == []
    readings = bench.camera.read(30_000_000)
    assert bench.camera.read(10 * EXPOSURE) == []
    x = POSE.x + 0.2 * cos(POSE.yaw) - 0.1 * sin(POSE.yaw)
    y = POSE.y + 0.2 * sin(POSE.yaw) + 0.1 * cos(POSE.yaw)
    assert readings
    for reading in readings:
        assert reading.beacon is not None
        bx, by = BEACONS[reading.beacon].at
        true = wrap(atan2(by - y, bx - x) - POSE.yaw)
        assert (reading.kind, reading.t, reading.delivered) == ("azimuth", 0, 30_000_000)
        assert reading.value[0] == pytest.approx(true, abs=3e-4)
        assert 0.0 < reading.std[0] < 3e-4


def test_scanning_sees_every_beacon_and_the_witness_hears_the_truth() -> None:
    bench = Bench({"pan": {"kind": "scanning", "rate": 2.0}}, rendered=True)
    readings = bench.expose(40, POSE)
    assert {reading.beacon for reading in readings} == {0, 1, 2, 3}
    assert [note[0] for note in bench.notes.readings] == readings
    for reading, beacon, true in bench.notes.readings:
        assert reading.beacon == beacon
        bx, by = BEACONS[beacon].at
        assert true == pytest.approx(wrap(atan2(by - POSE.y, bx - POSE.x) - POSE.yaw))
        assert wrap(reading.value[0] - true) == pytest.approx(0.0, abs=3e-4)


def test_snapshots_show_the_frame_and_what_was_found_in_it() -> None:
    bench = Bench({"fov_deg": 100}, rendered=True)
    bench.expose(1, Pose(0.0, 0.0, pi / 4))
    (snapshot,) = bench.notes.snapshots
    assert snapshot.image.shape == (64, 640, 3)
    assert snapshot.beacons == (1, 0)
    for column, beacon in zip(snapshot.pixels, snapshot.beacons, strict=True):
        red, green, _ = snapshot.image[32, round(column)].tolist()
        assert (red, green) == ((255, 0) if beacon == 0 else (0, 255))


def test_the_time_is_split_between_rendering_and_vision() -> None:
    bench = Bench({}, rendered=True)
    bench.expose(3)
    assert bench.cost.render > 0.0
    assert bench.cost.vision > 0.0


def test_noise_is_added_and_stated() -> None:
    bench = Bench({"noise": 0.02, "fov_deg": 170})
    bench.expose(800)
    errors = [reading.value[0] - true for reading, _, true in bench.notes.readings]
    assert np.std(errors) == pytest.approx(0.02, rel=0.1)
    assert abs(np.mean(errors)) < 0.003
    assert all(reading.std[0] == pytest.approx(0.02, rel=1e-3) for reading, _, _ in bench.notes.readings)


def test_missed_detections_make_no_row() -> None:
    bench = Bench({"missed": 0.3})
    readings = bench.expose(2000)
    assert len(readings) == len(bench.notes.readings) == pytest.approx(1400, abs=80)


def test_a_lost_frame_makes_no_row_but_was_exposed() -> None:
    bench = Bench({"loss": 0.5})
    readings = bench.expose(200)
    assert len(readings) == len(bench.notes.readings) == pytest.approx(100, abs=30)
    assert len(bench.notes.snapshots) == 200


@pytest.mark.parametrize(("identity", "claims"), [("colour", {0, 1, 2, 3}), ("anonymous", {None})])
def test_spurious_azimuths_are_uniform_in_view_and_known_to_the_witness_alone(
    identity: str, claims: set[int | None]
) -> None:
    bench = Bench({"spurious": 0.5, "identity": identity, "pan": {"kind": "fixed", "angle": 3.0}})
    bench.expose(2000, Pose(0.0, 0.0, pi / 4))
    false = [(reading, true) for reading, beacon, true in bench.notes.readings if beacon == -1]
    assert len(false) == pytest.approx(1000, abs=120)
    assert all(isnan(true) for _, true in false)
    offsets = np.array([wrap(reading.value[0] - 3.0) for reading, _ in false])
    assert np.abs(offsets).max() <= pi / 4
    assert np.std(offsets) == pytest.approx(pi / 2 / np.sqrt(12), rel=0.06)
    assert {reading.beacon for reading, _ in false} == claims


def test_a_disturbance_adds_spurious_azimuths_and_blinds() -> None:
    bench = Bench({}, beacons=())
    assert bench.expose(50) == []
    bench.effects.spurious = 1.0
    assert len(bench.expose(100)) == pytest.approx(100, abs=35)
    bench.effects.blind = True
    frames = len(bench.notes.snapshots)
    assert bench.expose(20) == []
    assert len(bench.notes.snapshots) == frames == 150
    bench.effects.reset()
    bench.expose(1)
    assert len(bench.notes.snapshots) == 151


def test_a_claimed_identity_does_not_decide_the_truth() -> None:
    """The witness goes by geometry: a detector that names the wrong beacon is found out."""
    bench = Bench({})
    detect = bench.ideal.detect
    bench.ideal.detect = lambda shot: [d._replace(beacon=3) for d in detect(shot)]  # type: ignore[method-assign]
    ((reading, beacon, _),) = bench.expose(1) and bench.notes.readings
    assert (reading.beacon, beacon) == (3, 0)


def test_the_same_seed_gives_the_same_bits_and_another_one_does_not() -> None:
    block = {"noise": 0.01, "missed": 0.2, "spurious": 0.3, "loss": 0.1, "pan": {"kind": "scanning"}}
    first, second, other = (Bench(block, rendered=True, seed=seed) for seed in (1, 1, 2))
    readings = [bench.expose(20, POSE) for bench in (first, second, other)]
    assert readings[0] == readings[1] != readings[2]
    for a, b in zip(first.notes.snapshots, second.notes.snapshots, strict=True):
        assert a.pixels == b.pixels
        assert_array_equal(a.image, b.image)


def test_beacons_of_one_colour_are_anonymous_to_the_controller_but_not_to_the_witness() -> None:
    twins = (BeaconSpec(at=(4.0, 1.0)), BeaconSpec(at=(4.0, -1.0)), BeaconSpec(at=(4.0, 0.0), colour="blue"))
    bench = Bench({}, twins, rendered=True)
    bench.expose(1)
    assert [(reading.beacon, beacon) for reading, beacon, _ in bench.notes.readings] == [
        (None, 0),
        (2, 2),
        (None, 1),
    ]


def test_no_beacons_and_a_beacon_around_the_camera() -> None:
    assert Bench({}, beacons=(), rendered=True).expose(2) == []
    around = Bench({}, beacons=(BeaconSpec(at=(0.0, 0.0)),), rendered=True)
    around.expose(2)
    assert len(around.notes.snapshots) == 2


def test_due_follows_the_rate() -> None:
    bench = Bench({"rate": 20.0})
    dues = []
    for _ in range(3):
        dues.append(bench.camera.due)
        bench.camera.sample(Truth(bench.camera.due, POSE))
    assert dues == [0, 50_000_000, 100_000_000]


@pytest.mark.parametrize(
    "block",
    [
        {"width": 0},
        {"width": 8},
        {"height": 100_000},
        {"fov_deg": 180},
        {"fov_deg": 0},
        {"fov_deg": float("nan")},
        {"renderer": "vulkan"},
        {"renderer": "egl", "width": 1280},
        {"mount": [0.0, 0.0, 0.0]},
        {"mount": [0.0, 0.0]},
        {"missed": 1.1},
        {"noise": -0.1},
        {"spurious": -1},
        {"widht": 640},
    ],
)
def test_a_camera_that_cannot_be_is_refused(block: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        CameraSpec.model_validate(block)


def test_defaults() -> None:
    spec = CameraSpec()
    assert (spec.width, spec.height, spec.fov_deg, spec.rate, spec.latency) == (640, 64, 90.0, 10.0, 0.05)
    assert (spec.noise, spec.missed, spec.spurious, spec.identity) == (0.0, 0.0, 0.0, "colour")
    assert (spec.renderer, spec.pan.kind) == ("tiny", "fixed")


def test_checking_a_scenario_loads_no_heavy_library() -> None:
    code = (
        "import sys, hilbed.sensors.camera; sys.exit(bool({'cv2', 'pybullet', 'scipy'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0
