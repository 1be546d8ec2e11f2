"""The colour detector on rendered frames, against OpenCV's projection of the beacons' axes."""

from __future__ import annotations

from math import atan, degrees, pi

import numpy as np
import pytest

from hilbed.scene import COLOURS as ALL_COLOURS
from hilbed.scene import BeaconSpec
from hilbed.vision.detect import ColourDetector
from hilbed.vision.lens import Lens
from hilbed.vision.seams import Detection, Viewpoint
from tests.vision.scenes import AHEAD, COLOURS, WIDE, axis, beacon, project, renderer, shot


def true_azimuth(spec: BeaconSpec, lens: Lens, eye: tuple[float, float, float], yaw: float) -> float:
    pixels = project(axis(spec), lens, eye, yaw)
    assert pixels[0, 0] == pytest.approx(pixels[1, 0], abs=1e-9)
    return atan((lens.cx - pixels[0, 0]) / lens.fx)


def seen(beacons: list[BeaconSpec], yaw: float = 0.0, anonymous: bool = False) -> list[Detection]:
    camera = renderer(beacons)
    image = camera.render(Viewpoint(0.0, 0.0, 0.3, yaw), 0)
    camera.close()
    return ColourDetector(WIDE, beacons, anonymous).detect(shot(image))


def errors(frames: int, nearest: float, farthest: float) -> tuple[np.ndarray, np.ndarray, int]:
    """Returns errors and stated standard deviations (rad) of all detections, and how many were expected."""
    rng = np.random.default_rng(11)
    found, stated, expected = [], [], 0
    for _ in range(frames // 5):
        azimuths = np.linspace(-0.6, 0.6, 6) + rng.uniform(-0.05, 0.05, 6)
        distances = rng.uniform(nearest, farthest, 6)
        beacons = [beacon(a, d, c) for a, d, c in zip(azimuths, distances, COLOURS, strict=True)]
        camera, detector = renderer(beacons), ColourDetector(WIDE, beacons)
        for _ in range(5):
            x, y, z, yaw = rng.uniform((-0.1, -0.1, 0.15, -0.08), (0.1, 0.1, 0.5, 0.08)).tolist()
            expected += len(beacons)
            for detection in detector.detect(shot(camera.render(Viewpoint(x, y, z, yaw), 0))):
                assert detection.beacon is not None
                truth = true_azimuth(beacons[detection.beacon], WIDE, (x, y, z), yaw)
                found.append(detection.azimuth - truth)
                stated.append(detection.std)
        camera.close()
    return np.array(found), np.array(stated), expected


def test_azimuths_from_2_to_8_m_are_exact_and_say_how_exact() -> None:
    error, stated, expected = errors(100, 2.0, 8.0)
    millidegrees = 1e3 * np.degrees(error)
    assert error.size >= 0.97 * expected
    assert abs(millidegrees.mean()) <= 0.5
    assert millidegrees.std() <= 5.0
    assert np.abs(millidegrees).max() <= 30.0
    assert 0.7 <= np.sqrt(np.mean((error / stated) ** 2)) <= 1.3


def test_no_bias_where_left_and_right_edge_differ_in_depression() -> None:
    """Beacons near the border of a tall image, well below the camera: a plain mean is 57 mdeg off."""
    lens, eye = Lens.of_fov(640, 480, pi / 2), (0.0, 0.0, 1.0)
    millidegrees = []
    for azimuth in np.linspace(0.45, 0.7, 60):
        spec = beacon(float(azimuth), 1.0)
        camera = renderer([spec], lens)
        image = camera.render(Viewpoint(*eye, 0.0), 0)
        (detection,) = ColourDetector(lens, [spec]).detect(shot(image, lens))
        camera.close()
        millidegrees.append(1e3 * degrees(detection.azimuth - true_azimuth(spec, lens, eye, 0.0)))
    assert abs(np.mean(millidegrees)) <= 2.0
    assert np.std(millidegrees) <= 10.0


def test_cylinders_are_coarser_and_say_so() -> None:
    rng = np.random.default_rng(5)
    normalised, millidegrees = [], []
    for _ in range(60):
        spec = beacon(rng.uniform(-0.6, 0.6), rng.uniform(2.0, 8.0), foot_radius=0.05, top_radius=0.05)
        (detection,) = seen([spec])
        error = detection.azimuth - true_azimuth(spec, WIDE, (0.0, 0.0, 0.3), 0.0)
        normalised.append(error / detection.std)
        millidegrees.append(1e3 * degrees(error))
    assert 0.6 <= np.sqrt(np.mean(np.square(normalised))) <= 1.4
    assert np.std(millidegrees) > 15.0


@pytest.mark.parametrize("colour", list(ALL_COLOURS))
def test_every_colour_is_told_from_its_neighbours(colour: str) -> None:
    beacons = [beacon(0.0, 3.0, name) if name == colour else beacon(pi, 3.0, name) for name in ALL_COLOURS]
    (detection,) = seen(beacons)
    assert detection.beacon == list(ALL_COLOURS).index(colour)


def test_identity_is_none_for_a_shared_colour_and_for_all_if_anonymous() -> None:
    beacons = [beacon(0.4, 3.0, "red"), beacon(0.0, 3.0, "green"), beacon(-0.4, 3.0, "red")]
    assert [d.beacon for d in seen(beacons)] == [None, 1, None]
    assert [d.beacon for d in seen(beacons, anonymous=True)] == [None, None, None]


def test_detections_come_from_left_to_right_with_their_columns() -> None:
    detections = seen([beacon(-0.4, 3.0, "red"), beacon(0.0, 3.0, "green"), beacon(0.4, 3.0, "blue")])
    assert [d.beacon for d in detections] == [2, 1, 0]
    for detection in detections:
        assert detection.column == pytest.approx(WIDE.column(detection.azimuth))


def test_a_colour_that_no_beacon_has_is_not_a_beacon() -> None:
    image = renderer([beacon(0.0, 3.0, "blue")]).render(AHEAD, 0)
    assert ColourDetector(WIDE, [beacon(0.0, 3.0, "red")]).detect(shot(image)) == []


@pytest.mark.parametrize(("colours", "pixels"), [(("red", "green"), 0.15), (("red", "red"), 0.5)])
def test_one_beacon_passing_before_another_gives_no_wrong_azimuth(
    colours: tuple[str, str], pixels: float
) -> None:
    """The far one is hidden bit by bit; what is measured of either must stay right."""
    far = beacon(0.0, 6.0, colours[0])
    counts = set()
    for offset in np.linspace(-0.06, 0.06, 81):
        near = beacon(float(offset), 3.0, colours[1])
        detections = seen([far, near])
        counts.add(len(detections))
        for detection in detections:
            error = min(abs(detection.azimuth), abs(detection.azimuth - offset))
            assert error <= pixels / WIDE.fx, (offset, detection)
    assert 2 in counts


def test_the_nearer_of_two_in_line_is_the_one_seen() -> None:
    (detection,) = seen([beacon(0.1, 6.0, "red"), beacon(0.1, 3.0, "green")])
    assert detection.beacon == 1
    assert detection.azimuth == pytest.approx(0.1, abs=1e-4)


def test_a_beacon_leaving_the_image_is_never_measured_wrongly() -> None:
    spec = beacon(0.0, 2.0)
    outcomes = set()
    for yaw in np.linspace(pi / 4 - 0.08, pi / 4 + 0.08, 81):
        detections = seen([spec], yaw=float(yaw))
        outcomes.add(len(detections))
        for detection in detections:
            assert detection.azimuth == pytest.approx(-yaw, abs=0.25 / WIDE.fx)
    assert outcomes == {0, 1}


def test_a_far_beacon_of_a_few_pixels_is_left_out_or_right() -> None:
    for distance in (12.0, 20.0, 40.0, 80.0):
        for detection in seen([beacon(0.2, distance)]):
            assert detection.azimuth == pytest.approx(0.2, abs=4.0 * detection.std)
    assert seen([beacon(0.2, 80.0)]) == []


def test_a_frame_of_any_content_gives_a_list() -> None:
    detector = ColourDetector(WIDE, [beacon(0.0, 3.0, c) for c in COLOURS])
    rng = np.random.default_rng(0)
    shape = (WIDE.height, WIDE.width, 3)
    frames = [np.full(shape, level, np.uint8) for level in (0, 128, 255)]
    frames += [np.broadcast_to(np.array([255, 0, 0], np.uint8), shape)]
    frames += [rng.integers(0, 256, shape, np.uint8) for _ in range(5)]
    frames += [np.repeat(rng.integers(0, 256, (*shape[:2], 1), np.uint8), 3, axis=2)]
    for frame in frames:
        assert all(np.isfinite(d.azimuth) and d.std > 0.0 for d in detector.detect(shot(frame)))


def test_no_beacon_at_all() -> None:
    assert seen([]) == []
