"""The renderer against an independent projection: every pixel, in OpenCV's convention."""

from __future__ import annotations

from ctypes import CDLL
from math import pi

import cv2
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from hilbed.cost import Cost
from hilbed.types import ScenarioError
from hilbed.vision import egl
from hilbed.vision.detect import ColourDetector
from hilbed.vision.lens import Lens
from hilbed.vision.render import BulletRenderer, Scenery
from hilbed.vision.seams import Viewpoint
from tests.vision.scenes import AHEAD, COLOURS, WIDE, beacon, outline, renderer, shot


@pytest.fixture(scope="module")
def working_egl() -> None:
    if egl.trouble():
        pytest.skip(f"EGL does not work on this machine: {egl.trouble()}")


def assert_pixels_match(lens: Lens, with_egl: bool) -> None:
    rng = np.random.default_rng(7)
    for _ in range(6):
        spec = beacon(rng.uniform(-0.6, 0.6), rng.uniform(2.0, 6.0))
        eye, yaw = (0.1, -0.2, float(rng.uniform(0.1, 0.7))), float(rng.uniform(-0.1, 0.1))
        camera = renderer([spec], lens, with_egl)
        image = camera.render(Viewpoint(*eye, yaw), 0)
        camera.close()
        red = image[..., 0].astype(int) - image[..., 2] > 60
        assert red.any()
        hull = outline(spec, lens, eye, yaw).astype(np.float32)
        for row, column in np.ndindex(lens.height, lens.width):
            depth = cv2.pointPolygonTest(hull, (float(column), float(row)), True)
            if abs(depth) > 0.15:
                assert red[row, column] == (depth > 0), (row, column, depth)


@pytest.mark.parametrize("lens", [Lens.of_fov(320, 48, pi / 2), Lens.of_fov(161, 121, 1.5)])
def test_tiny_colours_exactly_the_pixels_whose_centre_is_inside(lens: Lens) -> None:
    assert_pixels_match(lens, with_egl=False)


@pytest.mark.usefixtures("working_egl")
def test_egl_colours_exactly_the_pixels_whose_centre_is_inside() -> None:
    assert_pixels_match(Lens.of_fov(320, 48, pi / 2), with_egl=True)


@pytest.mark.usefixtures("working_egl")
def test_both_renderers_lead_to_the_same_detections() -> None:
    rng = np.random.default_rng(3)
    beacons = [beacon(k * 0.22 - 0.55, 2.0 + k, c) for k, c in enumerate(COLOURS)]
    detector = ColourDetector(WIDE, beacons)
    cameras = [renderer(beacons, egl=with_egl) for with_egl in (False, True)]
    differences = []
    for _ in range(10):
        pose = (rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), 0.3, rng.uniform(-0.1, 0.1))
        tiny, opengl = (detector.detect(shot(camera.render(Viewpoint(*pose), 0))) for camera in cameras)
        assert [d.beacon for d in tiny] == [d.beacon for d in opengl]
        differences += [a.column - b.column for a, b in zip(tiny, opengl, strict=True)]
    assert len(differences) > 40
    assert np.std(differences) <= 0.05
    assert abs(np.mean(differences)) <= 0.01
    for camera in cameras:
        camera.close()


@pytest.mark.usefixtures("working_egl")
def test_egl_writes_nothing_on_standard_output(capfd: pytest.CaptureFixture[str]) -> None:
    camera = renderer([beacon(0.0, 2.0)], egl=True)
    for _ in range(3):
        camera.render(AHEAD, 0)
    camera.close()
    CDLL(None).fflush(None)
    assert capfd.readouterr().out == ""


@pytest.mark.usefixtures("working_egl")
def test_egl_refuses_a_frame_that_it_would_stretch() -> None:
    with pytest.raises(ScenarioError, match="1024×768"):
        renderer([], Lens.of_fov(1280, 64, 1.0), egl=True)


def test_egl_that_does_not_work_is_told_and_not_loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(egl, "trouble", lambda: "a trial in a child process ended with -11")
    with pytest.raises(ScenarioError, match=r"-11.*renderer: tiny"):
        renderer([], egl=True)


def test_a_beacon_shows_its_exact_colour_on_white_and_the_ground_is_grey() -> None:
    spec = beacon(0.0, 2.0, "orange")
    for ground, colours in (
        (False, {(255, 127, 0), (255, 255, 255)}),
        (True, {(255, 127, 0), (255,) * 3, (153,) * 3}),
    ):
        camera = BulletRenderer(WIDE, Scenery([spec], ground=ground), Cost())
        image = camera.render(AHEAD, 0)
        camera.close()
        assert {tuple(colour) for colour in image.reshape(-1, 3).tolist()} == colours


def test_frames_are_the_same_to_the_bit_and_never_shared() -> None:
    beacons = [beacon(0.3, 2.0), beacon(-0.3, 3.0, "green")]
    first, second = renderer(beacons), renderer(beacons)
    image = first.render(Viewpoint(0.1, 0.2, 0.3, 0.05), 0)
    kept = image.copy()
    first.render(Viewpoint(-1.0, 0.0, 0.3, 1.0), 0)
    assert_array_equal(image, kept)
    assert_array_equal(second.render(Viewpoint(0.1, 0.2, 0.3, 0.05), 0), kept)
    assert (image.shape, image.dtype, image.flags.c_contiguous) == ((64, 640, 3), np.uint8, True)


@pytest.mark.parametrize("distance", [0.0, 0.01, 0.06, 0.1])
def test_a_camera_in_or_at_a_beacon_gets_a_frame_and_no_wrong_azimuth(distance: float) -> None:
    spec = beacon(0.0, distance)
    image = renderer([spec]).render(AHEAD, 0)
    assert image.shape == (64, 640, 3)
    assert all(abs(d.azimuth) < 0.1 for d in ColourDetector(WIDE, [spec]).detect(shot(image)))


def test_a_beacon_behind_the_camera_is_not_drawn() -> None:
    image = renderer([beacon(pi, 2.0)]).render(AHEAD, 0)
    assert (image == 255).all()


@pytest.mark.parametrize("size", [(16, 16), (4096, 16), (17, 33)])
def test_any_size(size: tuple[int, int]) -> None:
    lens = Lens.of_fov(*size, 1.0)
    assert renderer([beacon(0.0, 2.0)], lens).render(AHEAD, 0).shape == (lens.height, lens.width, 3)


def test_rendering_is_charged_as_rendering() -> None:
    cost = Cost()
    BulletRenderer(WIDE, Scenery([]), cost).render(AHEAD, 0)
    assert cost.render > 0.0
    assert cost.vision == 0.0
