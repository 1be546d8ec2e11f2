"""Floor and walls, against rays cast through every pixel."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from hilbed.cost import Cost
from hilbed.scene import BeaconSpec, FloorSpec, ScenerySpec, WallsSpec
from hilbed.scene.scenery import SurfaceSpec
from hilbed.types import Image
from hilbed.vision.backdrop import Backdrop
from hilbed.vision.clip import clip
from hilbed.vision.detect import ColourDetector
from hilbed.vision.render import BulletRenderer, Scenery
from hilbed.vision.seams import Viewpoint
from hilbed.vision.textures import PATTERNS, SIZE, tile
from tests.vision.oracle import SKEWED, Pin, pixels, rays, room
from tests.vision.scenes import COLOURS, WIDE, beacon, shot

ROOM = WallsSpec(corner=(-4.0, -3.0), opposite=(4.0, 3.0), height=1.5, colour=(0.0, 1.0, 0.0))
PLAIN = ScenerySpec(sky=(0.0, 0.0, 1.0), floor=FloorSpec(colour=(1.0, 0.0, 0.0)), walls=ROOM)
FLAT = Pin(640, 64, 320.0, 320.0, 319.5, 31.5)
INDEX = np.array([[0, 0, 255], [255, 0, 0], [0, 255, 0]], np.uint8)  # sky, floor, wall


def views(count: int) -> list[Viewpoint]:
    rng = np.random.default_rng(2)
    low, high = (-3.5, -2.5, 0.1, -3.14, -1.5, -3.0), (3.5, 2.5, 1.4, 3.14, 1.5, 3.0)
    return [Viewpoint(*rng.uniform(low, high).tolist()) for _ in range(count)]


def near_an_edge(kinds: Image) -> Image:
    """Returns where one of the pixels around is of another kind."""
    found = np.zeros(kinds.shape, bool)
    for down in (-1, 0, 1):
        for right in (-1, 0, 1):
            found |= np.roll(kinds, (down, right), (0, 1)) != kinds
    found[0] = found[-1] = found[:, 0] = found[:, -1] = True
    return found


@pytest.mark.parametrize("pin", [SKEWED, FLAT], ids=["skewed", "flat"])
def test_every_pixel_shows_what_its_ray_hits_first(pin: Pin) -> None:
    backdrop = Backdrop(pin, PLAIN, [])
    shown = set()
    for view in views(40):
        kinds = room(pin, view, (4.0, 3.0, 1.5))
        sure = ~near_an_edge(kinds)
        assert_array_equal(backdrop.paint(view)[sure], INDEX[kinds][sure])
        shown |= set(np.unique(kinds))
    assert shown == {0, 1, 2}


@pytest.mark.parametrize("pattern", ["plain", "wood"])
def test_any_view_gives_a_frame(pattern: str) -> None:
    """Straight up and down, upside down, on the floor, in a corner, inside a wall, outside."""
    surface = {"pattern": pattern, "tile": 0.05}
    walls = WallsSpec.model_validate({**surface, "corner": (-4.0, -3.0), "opposite": (4.0, 3.0)})
    backdrop = Backdrop(SKEWED, ScenerySpec(floor=FloorSpec.model_validate(surface), walls=walls), [])
    places = [(0.0, 0.0, 0.3), (4.0, 3.0, 0.0), (4.0, 0.0, 0.3), (3.9999, 2.9999, 0.0001), (50.0, 0.0, 0.3)]
    for x, y, z in places:
        for pitch in (-pi / 2, -0.3, 0.0, 1e-9, pi / 2):
            for roll in (0.0, pi):
                image = backdrop.paint(Viewpoint(x, y, z, 0.7, pitch, roll))
                assert (image.shape, image.dtype) == ((200, 320, 3), np.uint8)


def test_the_horizon_of_a_floor_without_walls_is_level_with_the_camera() -> None:
    backdrop = Backdrop(SKEWED, ScenerySpec(floor=FloorSpec(colour=(0.0, 0.0, 0.0))), [])
    dark = backdrop.paint(Viewpoint(0.0, 0.0, 0.3, 0.4))[:, 100, 0] == 0
    assert abs(int(np.argmax(dark)) - SKEWED.cy) <= 2.0
    assert dark[int(np.argmax(dark)) :].all()


def test_a_checkered_floor_changes_colour_where_rays_cross_the_lines() -> None:
    floor = FloorSpec(pattern="checker", tile=2.0, colour=(1.0, 1.0, 1.0), second=(0.0, 0.0, 0.0))
    backdrop = Backdrop(SKEWED, ScenerySpec(floor=floor, walls=ROOM), [])
    compared = 0
    for view in (Viewpoint(0.3, -0.4, 1.0, yaw, 0.5, 0.1) for yaw in (0.0, 1.0, 2.5, 4.0)):
        ray = rays(SKEWED, view)
        way = np.where(ray[..., 2] < 0.0, -view.z / ray[..., 2], 0.0)
        x, y = view.x + way * ray[..., 0] + 4.0, view.y + way * ray[..., 1] + 3.0
        white = (np.floor(x).astype(int) + np.floor(y).astype(int)) % 2 == 1
        near = (room(SKEWED, view, (4.0, 3.0, 1.5)) == 1) & (way < 3.0)
        sure = near & ~near_an_edge(white) & (np.minimum(x % 1.0, y % 1.0) > 0.05)
        sure &= np.maximum(x % 1.0, y % 1.0) < 0.95
        assert_array_equal(backdrop.paint(view)[..., 0][sure] > 127, white[sure])
        compared += int(sure.sum())
    assert compared > 10_000


@pytest.mark.parametrize("pattern", sorted(PATTERNS))
def test_a_pattern_has_no_seam_and_mixes_its_colours(pattern: str) -> None:
    surface = SurfaceSpec.model_validate({"pattern": pattern, "colour": "grey", "second": [0.2, 0.2, 0.2]})
    image = tile(surface)[..., 0].astype(float)
    if pattern == "plain":
        assert image.shape == (1, 1)
        return
    assert image.shape == (SIZE, SIZE)
    assert image.std() > 5.0
    for axis in (0, 1):
        steps = np.abs(np.diff(np.concatenate((image, image.take([0], axis)), axis), axis=axis)).mean(
            1 - axis
        )
        assert steps[-1] <= steps[:-1].max()


@pytest.mark.parametrize("scenery", ["plain", "patterned"])
def test_detections_do_not_depend_on_what_lies_behind(scenery: str) -> None:
    beacons = [beacon(k * 0.22 - 0.55, 2.0 + 0.3 * k, c) for k, c in enumerate(COLOURS)]
    pattern = "plain" if scenery == "plain" else "bricks"
    around = ScenerySpec(floor=FloorSpec(pattern="wood"), walls=WallsSpec(pattern=pattern))
    detector = ColourDetector(WIDE, beacons)
    found = []
    for one in (ScenerySpec(), around):
        camera = BulletRenderer(WIDE, Scenery(beacons, around=one), Cost())
        found.append(detector.detect(shot(camera.render(Viewpoint(0.1, 0.0, 0.3, 0.05), 0))))
        camera.close()
    assert len(found[0]) == len(COLOURS)
    assert found[0] == found[1]


def test_walls_stand_around_the_outermost_beacons() -> None:
    beacons = [BeaconSpec(at=(3.0, 1.0)), BeaconSpec(at=(-1.0, -2.0))]
    backdrop = Backdrop(SKEWED, ScenerySpec(walls=WallsSpec(margin=0.5, colour=(0.0, 0.0, 0.0))), beacons)
    view = Viewpoint(0.0, 0.0, 0.5, 0.0)
    ((column, row),) = pixels(np.array([[3.5, 0.0, 1.0]]), SKEWED, view)
    black = backdrop.paint(view)[:, round(column), 0] == 0
    assert int(np.argmax(black)) == pytest.approx(row, abs=1.0)


def test_a_cut_triangle_keeps_what_is_on_the_right_side() -> None:
    triangle = [(0.0, 0.0, 1.0), (4.0, 0.0, 1.0), (0.0, 4.0, 1.0)]
    cut = clip(triangle, [(1.0, 0.0, 0.0, -1.0)])
    assert sorted(cut) == [(1.0, 0.0, 1.0), (1.0, 3.0, 1.0), (4.0, 0.0, 1.0)]
    assert clip(triangle, [(1.0, 0.0, 0.0, -5.0)]) == []
    assert clip(triangle, [(1.0, 0.0, 0.0, 5.0)]) == triangle
