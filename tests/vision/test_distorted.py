"""Frames of lenses that distort or are tilted, and their truth, against cv2.projectPoints."""

from __future__ import annotations

from math import atan2, cos, hypot
from typing import Any

import cv2
import numpy as np
import pytest

from hilbed.cost import Cost
from hilbed.scene import BeaconSpec
from hilbed.sensors.camera import CameraSpec
from hilbed.sensors.exposure import Exposure, still
from hilbed.sensors.eye import Setting
from hilbed.sensors.imager import open_imager
from hilbed.types import Array, Pose
from hilbed.vision import egl
from hilbed.vision.detect import ColourDetector
from hilbed.vision.lens import Lens
from hilbed.vision.seams import ShotTruth, Viewpoint
from tests.vision.scenes import COLOURS, beacon

BARREL: dict[str, Any] = {"k1": -0.1, "k2": 0.01, "p1": 1e-3, "p2": -5e-4}
LENSES: dict[str, dict[str, Any]] = {
    "pinhole": {},
    "barrel": BARREL,
    "pincushion": {"k1": 0.1, "fx": 330.0, "fy": 325.0, "cx": 322.5, "cy": 30.25},
    "tilted": {"tilt_deg": 5.0, "height": 128},
    "everything": {**BARREL, "tilt_deg": -4.0, "roll_deg": 3.0, "height": 128},
}


def by_opencv(point: tuple[float, float, float], lens: Lens, view: Viewpoint) -> Array:
    """Returns the pixel of a point in the map, by rotation matrices and cv2 alone."""
    turns = [
        cv2.Rodrigues(np.array(axis) * angle)[0]
        for axis, angle in (((0.0, 0, 1), view.yaw), ((0.0, 1, 0), view.pitch), ((1.0, 0, 0), view.roll))
    ]
    body = turns[0] @ turns[1] @ turns[2]
    optical = np.array([[0.0, -1, 0], [0, 0, -1], [1, 0, 0]]) @ body.T
    pixels, _ = cv2.projectPoints(
        np.array([point]),
        cv2.Rodrigues(optical)[0],
        -optical @ np.array(view[:3]),
        lens.matrix,
        lens.distortion,
    )
    return np.asarray(pixels, float).ravel()


class Frame:
    """One scene seen from a random place, with all that the tests ask about."""

    def __init__(self, block: dict[str, Any], rng: np.random.Generator) -> None:
        spec = CameraSpec.model_validate(block)
        azimuths = np.linspace(-0.6, 0.6, 6) + rng.uniform(-0.05, 0.05, 6)
        distances = rng.uniform(1.5, 7.0, 6)
        places = zip(azimuths, distances, COLOURS, strict=True)
        self.beacons = tuple(beacon(float(a), float(d), c) for a, d, c in places)
        self.imager = open_imager(spec, Setting(self.beacons), Cost())
        self.lens, self.detector = spec.lens, ColourDetector(spec.lens, self.beacons)
        self.rng = rng

    def exposures(self, count: int) -> list[Exposure]:
        low, high = (-0.1, -0.1, -0.08), (0.1, 0.1, 0.08)
        return [still(0, Pose(*self.rng.uniform(low, high).tolist())) for _ in range(count)]


def columns_off(block: dict[str, Any], scenes: int = 10) -> tuple[Array, Array, int]:
    """Returns by how many pixels detections are off, what they state, and how many are missing."""
    rng, off, stated, expected = np.random.default_rng(2), [], [], 0
    for _ in range(scenes):
        frame = Frame(block, rng)
        for exposure in frame.exposures(6):
            view = frame.imager.viewpoint(exposure.moments[0])
            expected += len(frame.beacons)
            for found in frame.detector.detect(frame.imager.shoot(exposure)):
                assert found.beacon is not None
                spec = frame.beacons[found.beacon]
                distance = hypot(spec.at[0] - view.x, spec.at[1] - view.y)
                elevation = float(frame.lens.direction(found.column, found.row)[1])
                point = (*spec.at, view.z + distance * np.tan(elevation))
                off.append(found.column - by_opencv(point, frame.lens, view)[0])
                stated.append(found.std * abs(cos(found.azimuth) ** -2) * frame.lens.fx)
        frame.imager.close()
    return np.array(off), np.array(stated), expected - len(off)


def frame_is_upright(name: str) -> bool:
    return "tilt_deg" not in LENSES[name]


@pytest.mark.parametrize("name", LENSES)
def test_what_is_seen_is_where_opencv_projects_it(name: str) -> None:
    off, stated, missing = columns_off(LENSES[name])
    assert missing <= 0.01 * off.size
    assert abs(off.mean()) <= 0.01
    assert np.std(off) <= (0.05 if frame_is_upright(name) else 0.08)  # a leaning edge crosses few columns
    assert 0.65 <= np.sqrt(np.mean((off / stated) ** 2)) <= 1.4


def test_what_egl_shows_through_a_distorting_lens_is_where_opencv_projects_it() -> None:
    if egl.trouble():
        pytest.skip(f"EGL does not work on this machine: {egl.trouble()}")
    off, _, missing = columns_off({**BARREL, "renderer": "egl"}, 3)
    assert missing <= 0.02 * off.size
    assert abs(off.mean()) <= 0.01


@pytest.mark.parametrize("name", LENSES)
def test_the_truth_of_a_frame_is_what_opencv_projects(name: str) -> None:
    frame = Frame({**LENSES[name], "pan": {"kind": "fixed", "angle": 0.1}}, np.random.default_rng(4))
    (exposure,) = frame.exposures(1)
    exposure = still(5, exposure.moments[0].pose, 0.1)
    truth = frame.imager.truth(exposure, frame.beacons)
    frame.imager.close()
    assert isinstance(truth, ShotTruth)
    assert (truth.t, truth.body, len(truth.beacons)) == (5, exposure.moments[0].pose, 6)
    for one, spec in zip(truth.beacons, frame.beacons, strict=True):
        pixel = by_opencv((*spec.at, spec.height / 2.0), frame.lens, truth.view)
        assert (one.column, one.row) == pytest.approx(tuple(pixel), abs=1e-6)
        dx, dy = spec.at[0] - truth.view.x, spec.at[1] - truth.view.y
        assert one.distance == pytest.approx(hypot(dx, dy))
        assert one.body_azimuth == pytest.approx(atan2(dy, dx) - truth.body.yaw)
        assert one.azimuth == pytest.approx(one.body_azimuth - 0.1)
        assert one.elevation == one.body_elevation == pytest.approx(atan2(0.25 - 0.3, one.distance))
        if one.box is not None:
            left, top, right, bottom = one.box
            assert left - 1 <= one.column <= right + 1
            assert 0 <= top <= bottom < frame.lens.height
            assert 0 <= left <= right < frame.lens.width
            assert 0.0 < one.visible <= 1.0


def test_no_beacon_and_a_beacon_around_the_camera_give_a_frame_and_a_truth() -> None:
    for beacons in ((), (BeaconSpec(at=(0.0, 0.0)),), (BeaconSpec(at=(0.03, 0.0)),)):
        imager = open_imager(CameraSpec.model_validate(BARREL), Setting(beacons), Cost())
        exposure = still(0, Pose(0.0, 0.0, 0.0))
        assert imager.shoot(exposure).image.shape == (64, 640, 3)
        truth = imager.truth(exposure, beacons)
        assert len(truth.beacons) == len(beacons)
        assert all(0.0 <= one.visible <= 1.0 for one in truth.beacons)
        imager.close()
