"""Light from dark to glare, against closed forms."""

from __future__ import annotations

from math import cos, sin, tan

import cv2
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from hilbed.cost import Cost
from hilbed.scene import BeaconSpec, FloorSpec, LightSpec, ScenerySpec, WallsSpec
from hilbed.types import Image
from hilbed.vision.light import shade
from hilbed.vision.render import BulletRenderer, Scenery
from hilbed.vision.seams import Viewpoint
from tests.vision.oracle import SKEWED, pixels

AHEAD = Viewpoint(0.0, 0.0, 0.4, 0.0)
GREY = (0.4, 0.4, 0.4)
BEACON = BeaconSpec(at=(2.0, 0.0), colour="orange")


def seen(light: LightSpec, view: Viewpoint = AHEAD, **around: object) -> Image:
    scenery = ScenerySpec.model_validate({"sky": GREY, "light": light, **around})
    camera = BulletRenderer(SKEWED, Scenery([BEACON], around=scenery), Cost())
    image = camera.render(view, 0)
    camera.close()
    return image


def test_light_as_usual_changes_nothing() -> None:
    camera = BulletRenderer(SKEWED, Scenery([BEACON]), Cost())
    bare = camera.render(AHEAD, 0)
    camera.close()
    assert_array_equal(seen(LightSpec(), sky=(1.0, 1.0, 1.0)), bare)


@pytest.mark.parametrize(("level", "veil"), [(0.0, 0.0), (0.3, 0.0), (2.0, 0.0), (0.5, 0.2), (1.0, 1.0)])
def test_level_scales_and_veil_adds_until_white(level: float, veil: float) -> None:
    plain = seen(LightSpec()).astype(float)
    expected = np.minimum(plain * level + 255.0 * veil, 255.0)
    assert np.abs(seen(LightSpec(level=level, veil=veil)) - expected).max() <= 1.0


def test_a_matt_surface_is_as_bright_as_the_cosine_of_the_directed_light() -> None:
    light = LightSpec(directed=0.6, azimuth=0.5, elevation=0.4)
    assert shade(light, (0.0, 0.0, 1.0)) == pytest.approx(0.4 + 0.6 * sin(0.4))
    assert shade(light, (cos(0.5), sin(0.5), 0.0)) == pytest.approx(0.4 + 0.6 * cos(0.4))
    assert shade(light, (-1.0, 0.0, 0.0)) == pytest.approx(0.4)


def test_floor_walls_and_bodies_are_lit_alike() -> None:
    light = LightSpec(directed=1.0, azimuth=3.0, elevation=0.3)  # on the far wall, from behind the camera
    walls = WallsSpec(colour=(0.8, 0.8, 0.8), height=0.2)
    image = seen(light, floor=FloorSpec(colour=(0.8, 0.8, 0.8)), walls=walls)
    wall, floor = ([round(204.0 * shade(light, n))] * 3 for n in ((-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    column = image[:, 5].tolist()
    assert floor in column
    assert wall in image.reshape(-1, 3).tolist()
    beacon = image[image[..., 0] > image[..., 2].astype(int) + 60]
    assert beacon[:, 0].max() <= round(255.0 * cos(0.3))


@pytest.mark.parametrize("view", [AHEAD, Viewpoint(3.0, -2.0, 0.4, 0.2, -0.1, 0.15)], ids=["level", "rolled"])
def test_the_sun_stands_where_the_light_comes_from(view: Viewpoint) -> None:
    light = LightSpec(sun=1.0, azimuth=0.15, elevation=0.12, size=0.04)
    far = 1e7 * np.array([cos(0.12) * cos(0.15), cos(0.12) * sin(0.15), sin(0.12)])
    ((column, row),) = pixels(far[None], SKEWED, view)
    white = (seen(light, view) == 255).all(axis=2).astype(np.uint8)
    _, labels, stats, centres = cv2.connectedComponentsWithStats(white)
    spot = 1 + int(np.argmax(stats[1:, cv2.CC_STAT_AREA]))
    assert_allclose(centres[spot], (column, row), atol=1.5)
    assert stats[spot, cv2.CC_STAT_HEIGHT] > 2.0 * SKEWED.fy * tan(0.04) - 3.0
    assert labels[0, 0] != spot


def test_a_sun_behind_the_camera_is_not_seen() -> None:
    assert_array_equal(seen(LightSpec(sun=1.0, azimuth=3.1)), seen(LightSpec()))
