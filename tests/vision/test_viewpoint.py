"""A camera that is tilted, rolled and no square pinhole, against OpenCV's projection, in both renderers."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from hilbed.cost import Cost
from hilbed.scene import BeaconSpec
from hilbed.vision import egl
from hilbed.vision.detect import ColourDetector
from hilbed.vision.opengl import axes
from hilbed.vision.render import BulletRenderer, Scenery
from hilbed.vision.seams import Viewpoint
from tests.vision.oracle import SKEWED, depths, pixels, turn
from tests.vision.scenes import COLOURS, WIDE, axis, beacon, renderer, shot

SHAPES = [
    {"shape": "cone"},
    {"shape": "cylinder", "foot_radius": 0.1},
    {"shape": "sphere", "foot_radius": 0.12},
]


@pytest.fixture(params=["tiny", "egl"])
def with_egl(request: pytest.FixtureRequest) -> bool:
    if request.param == "egl" and egl.trouble():
        pytest.skip(f"EGL does not work on this machine: {egl.trouble()}")
    return bool(request.param == "egl")


@pytest.fixture(scope="module")
def working_egl() -> None:
    if egl.trouble():
        pytest.skip(f"EGL does not work on this machine: {egl.trouble()}")


def views(count: int) -> list[Viewpoint]:
    rng = np.random.default_rng(5)
    low, high = (-0.2, -0.2, 0.2, -0.3, -0.1, -0.3), (0.2, 0.2, 1.2, 0.3, 0.4, 0.3)
    return [Viewpoint(*rng.uniform(low, high).tolist()) for _ in range(count)]


def test_axes_are_those_of_the_three_rotations() -> None:
    for view in views(20):
        forward, left, up = axes(view)
        assert_allclose([[-a for a in left], [-a for a in up], forward], turn(view), atol=1e-14)


@pytest.mark.parametrize("shape", SHAPES, ids=[shape["shape"] for shape in SHAPES])
def test_labels_are_the_pixels_whose_centre_is_inside_the_outline(
    shape: dict[str, object], with_egl: bool
) -> None:
    spec = BeaconSpec.model_validate({"at": (2.5, 0.1), **shape})
    camera = BulletRenderer(SKEWED, Scenery([spec], with_egl), Cost())
    seen = 0
    for view in views(4):
        labels, image = camera.labels(view, 0), camera.render(view, 0)
        inside = depths(spec, SKEWED, view)
        sure = np.abs(inside) > 0.25
        assert_array_equal(labels[sure], (inside > 0.0)[sure])
        assert_array_equal(labels == 1, image[..., 1] < 100)
        seen += int(labels.any())
    camera.close()
    assert seen >= 3


@pytest.mark.usefixtures("working_egl")
def test_both_renderers_label_the_same_pixels() -> None:
    beacons = [
        BeaconSpec.model_validate({"at": (2.0 + 0.1 * k, 0.05 * k), "colour": colour})
        for k, colour in enumerate(COLOURS)
    ]
    tiny, opengl = (BulletRenderer(SKEWED, Scenery(beacons, way), Cost()) for way in (False, True))
    for view in views(6):
        assert (tiny.labels(view, 0) != opengl.labels(view, 0)).mean() < 1e-4
    tiny.close()
    opengl.close()


def test_labels_count_beacons_from_one_and_the_nearer_hides_the_other() -> None:
    beacons = [BeaconSpec(at=(4.0, 0.0), colour="red"), BeaconSpec(at=(2.0, 0.0), colour="red")]
    camera = BulletRenderer(SKEWED, Scenery(beacons), Cost())
    labels = camera.labels(Viewpoint(0.0, 0.0, 0.3, 0.0), 0)
    camera.close()
    assert set(np.unique(labels)) == {0, 2}


def test_azimuths_have_no_bias_against_the_projected_axis(with_egl: bool) -> None:
    rng = np.random.default_rng(3)
    errors = []
    for _ in range(8):
        azimuths = np.linspace(-0.6, 0.6, len(COLOURS)) + rng.uniform(-0.05, 0.05, len(COLOURS))
        distances = rng.uniform(2.0, 8.0, len(COLOURS))
        beacons = [beacon(a, d, c) for a, d, c in zip(azimuths, distances, COLOURS, strict=True)]
        camera, detector = renderer(beacons, egl=with_egl), ColourDetector(WIDE, beacons)
        for _ in range(10):
            low, high = (-0.1, -0.1, 0.15, -0.08), (0.1, 0.1, 0.5, 0.08)
            view = Viewpoint(*rng.uniform(low, high).tolist())
            for found in detector.detect(shot(camera.render(view, 0))):
                assert found.beacon is not None
                column = pixels(axis(beacons[found.beacon]), WIDE, view)[:, 0].mean()
                errors.append(found.column - column)
        camera.close()
    assert len(errors) > 450
    assert abs(np.mean(errors)) <= 0.01 - 3.0 * np.std(errors) / len(errors) ** 0.5
    assert np.std(errors) <= 0.05


@pytest.mark.usefixtures("working_egl")
def test_one_egl_renderer_draws_on_when_another_is_closed() -> None:
    first, second = (BulletRenderer(SKEWED, Scenery([BeaconSpec(at=(2.0, 0.0))], True), Cost()) for _ in "ab")
    view = Viewpoint(0.0, 0.0, 0.3, 0.0)
    kept = first.render(view, 0)
    first.close()
    assert_array_equal(second.render(view, 0), kept)
    second.close()
