"""Frames that take their time or are noisy: what becomes of edges, azimuths and their stated deviation."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from math import atan2
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hilbed.cost import Cost
from hilbed.scene import BeaconSpec, ScenerySpec
from hilbed.sensors.camera import CameraSpec
from hilbed.sensors.exposure import Exposure, Moment, still
from hilbed.sensors.eye import Setting
from hilbed.sensors.imager import open_imager
from hilbed.types import Pose, Rng
from hilbed.vision.detect import ColourDetector
from hilbed.vision.seams import Detection
from tests.vision.scenes import COLOURS, beacon

DISTORTION: dict[str, Any] = {"k1": -0.1, "k2": 0.01}


def motion(rate: float, span: float, yaw: float = 0.0) -> Exposure:
    """Returns an exposure in which the robot turns at `rate` (rad/s) past `yaw`."""
    half = round(1e9 * span / 2)
    moments = [Moment(k * half, Pose(0.0, 0.0, yaw + k * rate * span / 2), 0.0) for k in (-1, 0, 1)]
    return Exposure(0, tuple(moments))


def row_of_beacons(rng: Rng, farthest: float, count: int = 6) -> tuple[BeaconSpec, ...]:
    """Returns beacons of different colours from right to left, 1 to `farthest` m away."""
    azimuths = (np.linspace(-0.6, 0.6, 6) + rng.uniform(-0.03, 0.03, 6))[:count]
    places = zip(azimuths.tolist(), rng.uniform(1.0, farthest, count).tolist(), COLOURS, strict=False)
    return tuple(beacon(a, d, c) for a, d, c in places)


def judged(
    found: Sequence[Detection], exposure: Exposure, beacons: Sequence[BeaconSpec]
) -> Iterator[tuple[float, float]]:
    """Yields the error of each azimuth (rad), seen from the origin, and the deviation that it states."""
    for one in found:
        assert one.beacon is not None
        bx, by = beacons[one.beacon].at
        yield one.azimuth + exposure.at(0).pose.yaw - atan2(by, bx), one.std


def test_motion_smears_edges_evenly_and_leaves_the_azimuth() -> None:
    spec = CameraSpec(exposure=0.01)
    scene = (beacon(0.1, 2.0),)
    imager = open_imager(spec, Setting(scene), Cost())
    sharp, blurred = (imager.shoot(motion(rate, 0.01)) for rate in (0.0, 1.5))
    imager.close()
    row = blurred.image[40, :, 1].astype(float)
    assert set(np.unique(sharp.image[40, :, 1]).tolist()) == {0, 255}
    levels = np.count_nonzero((row > 0) & (row < 255))
    assert 7 <= levels <= 12  # two edges, 0.015 rad are 4.8 pixels
    detector = ColourDetector(spec.lens, scene)
    (one,), (other,) = detector.detect(sharp), detector.detect(blurred)
    assert other.azimuth == pytest.approx(one.azimuth, abs=2e-4)


def test_a_rolling_shutter_leans_what_stands_upright() -> None:
    spec = CameraSpec(readout=0.02)
    scene = (beacon(0.0, 2.0, foot_radius=0.1, top_radius=0.1, height=2.0),)
    imager = open_imager(spec, Setting(scene), Cost())
    image = imager.shoot(motion(1.0, 0.02)).image
    imager.close()
    middle = [np.flatnonzero(line[:, 1] < 128).mean() for line in image]
    expected = 0.02 * spec.lens.fx * 63 / 64  # turning left moves the picture to the right
    assert middle[-1] - middle[0] == pytest.approx(expected, abs=1.0)
    assert middle[32] == pytest.approx(spec.lens.column(0.0), abs=1.0)


def test_noise_of_a_frame_is_its_own_whatever_came_before() -> None:
    spec = CameraSpec(read_noise=0.05)
    scene = (beacon(0.0, 2.0),)
    here, there = still(7, Pose(0.0, 0.0, 0.0)), still(8, Pose(0.0, 0.0, 0.0))
    images = []
    for seed, exposures in ((1, (here,)), (1, (there, here)), (2, (here,))):
        imager = open_imager(spec, Setting(scene, seed=seed), Cost())
        images.append([imager.shoot(exposure).image for exposure in exposures])
        imager.close()
    assert (images[0][0] == images[1][1]).all()
    assert (images[1][0] != images[1][1]).any()
    assert (images[0][0] != images[2][0]).any()


@pytest.mark.parametrize(
    "block",
    [
        {},
        {"read_noise": 0.02, "shot_noise": 0.02},
        {"read_noise": 0.06},
        {"gain": 0.3, "read_noise": 0.02},
        {"exposure": 0.004},
        {"exposure": 0.004, "read_noise": 0.04, **DISTORTION},
    ],
)
def test_from_1_to_8_m_all_beacons_are_found_and_their_stated_deviation_is_right(
    block: dict[str, Any],
) -> None:
    spec, rng = CameraSpec.model_validate(block), np.random.default_rng(8)
    errors, normalised, expected = [], [], 0
    for scene in range(8):
        beacons = row_of_beacons(rng, 8.0)
        imager = open_imager(spec, Setting(beacons, seed=scene), Cost())
        detector = ColourDetector(spec.lens, beacons)
        for frame in range(8):
            exposure = motion(0.7 * (-1) ** frame, 0.004, float(rng.uniform(-0.05, 0.05)))
            expected += 6
            for error, std in judged(detector.detect(imager.shoot(exposure)), exposure, beacons):
                errors.append(error)
                normalised.append(error / std)
        imager.close()
    assert len(errors) == expected
    assert np.abs(errors).max() < 5e-4  # nothing that is no beacon
    assert np.degrees(np.std(errors)) <= 5e-3
    assert 0.7 <= np.sqrt(np.mean(np.square(normalised))) <= 1.3


def test_a_finer_camera_is_as_much_more_exact() -> None:
    spec, rng = CameraSpec(width=2560, height=32), np.random.default_rng(9)
    errors = []
    for _ in range(6):
        beacons = row_of_beacons(rng, 8.0)
        imager, detector = open_imager(spec, Setting(beacons), Cost()), ColourDetector(spec.lens, beacons)
        for _ in range(4):
            yaw = float(rng.uniform(-0.05, 0.05))
            detections = detector.detect(imager.shoot(still(0, Pose(0.0, 0.0, yaw))))
            assert [d.beacon for d in detections] == [5, 4, 3, 2, 1, 0]
            errors += [d.azimuth + yaw - atan2(*beacons[d.beacon or 0].at[::-1]) for d in detections]
        imager.close()
    assert np.degrees(np.std(errors)) <= 1.5e-3


def resident() -> float:
    """Returns the resident memory, MB."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def test_memory_stays_flat() -> None:
    """A leak of an image a frame would be 31 MB; scripts/camera_numbers.py --memory 10000 takes longer."""
    block = {"exposure": 0.004, "readout": 0.001, "read_noise": 0.02, **DISTORTION}
    spec, scene = CameraSpec.model_validate(block), (beacon(0.1, 2.0),)
    imager, detector = open_imager(spec, Setting(scene), Cost()), ColourDetector(spec.lens, scene)
    for frame in range(350):
        detector.detect(imager.shoot(motion(0.5, 0.005, 1e-4 * frame)))
        if frame == 99:
            before = resident()
    imager.close()
    assert resident() - before < 8.0


@pytest.mark.parametrize(("count", "rate"), [(6, 0.7), (6, 1.5), (1, 0.7)])
def test_a_rolling_shutter_costs_no_beacon_and_no_azimuth(count: int, rate: float) -> None:
    """Uncorrected, half of the beacons are left out and errors are twice the stated deviation."""
    spec, rng = CameraSpec(readout=0.005), np.random.default_rng(6)
    errors, normalised, expected = [], [], 0
    for _ in range(12 if count == 1 else 3):
        beacons = row_of_beacons(rng, 6.0, count)
        imager, detector = open_imager(spec, Setting(beacons), Cost()), ColourDetector(spec.lens, beacons)
        for frame in range(6):
            exposure = motion(rate * (-1) ** frame, 0.005, float(rng.uniform(-0.05, 0.05)))
            expected += count
            for error, std in judged(detector.detect(imager.shoot(exposure)), exposure, beacons):
                errors.append(error)
                normalised.append(error / std)
        imager.close()
    assert len(errors) == expected
    assert np.degrees(np.std(errors)) <= 9e-3
    assert 0.6 <= np.sqrt(np.mean(np.square(normalised))) <= 1.4


LIT = ScenerySpec.model_validate(
    {
        "floor": {"pattern": "wood", "colour": [0.62, 0.52, 0.42], "second": [0.5, 0.41, 0.33]},
        "walls": {"pattern": "bricks", "height": 1.2},
        "light": {"level": 0.9, "directed": 0.3, "azimuth": 1.0, "elevation": 0.8},
    }
)


@pytest.mark.parametrize(("block", "bias"), [({"height": 128}, 0.005), ({"exposure": 0.004}, 0.01)])
def test_textures_and_light_from_one_side_do_not_move_azimuths(block: dict[str, Any], bias: float) -> None:
    """Taken for blur, texture and shading move them by 0.04 to 0.14 pixel."""
    spec, rng, off = CameraSpec.model_validate(block), np.random.default_rng(7), []
    for scene in range(6):
        beacons = row_of_beacons(rng, 8.0)
        imager = open_imager(spec, Setting(beacons, scenery=LIT, seed=scene), Cost())
        detector = ColourDetector(spec.lens, beacons)
        for frame in range(6):
            exposure = motion(0.7 * (-1) ** frame, 0.004, float(rng.uniform(-0.05, 0.05)))
            for found in detector.detect(imager.shoot(exposure)):
                bx, by = beacons[found.beacon or 0].at
                error = found.azimuth + exposure.at(0).pose.yaw - atan2(by, bx)
                off.append(error * spec.lens.fx / np.cos(found.azimuth) ** 2)
        imager.close()
    assert len(off) >= 0.98 * 6 * 36
    assert abs(np.mean(off)) <= bias
    assert np.std(off) <= 0.05
