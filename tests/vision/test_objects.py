"""Markers, lamps and things that move, as the renderer shows them."""

from __future__ import annotations

from itertools import pairwise
from math import hypot, pi

import cv2
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from pydantic import ValidationError

from hilbed.clock import SECOND
from hilbed.cost import Cost
from hilbed.scene import BeaconSpec, FlashSpec, ObjectSpec, ScenerySpec
from hilbed.scene.beacons import DICTIONARIES
from hilbed.types import Image
from hilbed.vision import egl
from hilbed.vision.parts import marker_texture
from hilbed.vision.render import BulletRenderer, Scenery
from hilbed.vision.seams import Viewpoint
from hilbed.vision.walk import Walk
from tests.vision.oracle import SKEWED, Pin, rays

AHEAD = Viewpoint(0.0, 0.0, 0.4, 0.0)


def picture(
    beacons: list[BeaconSpec], view: Viewpoint = AHEAD, with_egl: bool = False, with_pin: Pin = SKEWED
) -> Image:
    camera = BulletRenderer(with_pin, Scenery(beacons, with_egl), Cost())
    image = camera.render(view, 0)
    camera.close()
    return image


def board(**more: object) -> BeaconSpec:
    whole = {"at": (1.2, 0.1), "shape": "board", "foot_radius": 0.2, "height": 0.7, "marker": 7, **more}
    return BeaconSpec.model_validate(whole)


def cells_seen(spec: BeaconSpec, view: Viewpoint) -> np.ndarray:
    """Returns (H, W): brightness of a board's cell that each pixel's ray hits, −1 beside it."""
    cells = marker_texture(spec.dictionary, spec.marker or 0).astype(int)
    count, radius = len(cells), spec.foot_radius
    angle = spec.facing or 0.0
    normal, right = (
        np.array([np.cos(angle), np.sin(angle), 0.0]),
        np.array([-np.sin(angle), np.cos(angle), 0.0]),
    )
    centre = np.array([*spec.at, spec.height - radius])
    ray, eye = rays(SKEWED, view), np.array([view.x, view.y, view.z])
    way = ((centre - eye) @ normal) / (ray @ normal)
    hit = eye + way[..., None] * ray - centre
    across, down = (hit @ right + radius) / (2 * radius), (radius - hit[..., 2]) / (2 * radius)
    on = (way > 0) & (np.abs(across - 0.5) < 0.5) & (np.abs(down - 0.5) < 0.5)
    column, row = (np.clip((part * count).astype(int), 0, count - 1) for part in (across, down))
    return np.where(on, cells[row, column], -1)


def test_a_tilted_rolled_camera_sees_every_cell_of_a_marker_where_rays_hit_it() -> None:
    spec = board(facing=pi - 0.6)
    view = Viewpoint(0.0, 0.0, 0.6, 0.1, 0.1, 0.2)
    seen, expected = picture([spec], view)[..., 0].astype(int), cells_seen(spec, view)
    assert (expected >= 0).sum() > 3000
    assert (seen != expected)[expected >= 0].mean() < 0.002  # rounding where a ray hits the line itself


def test_egl_blurs_a_marker_by_a_pixel_at_most() -> None:
    if egl.trouble():
        pytest.skip(f"EGL does not work on this machine: {egl.trouble()}")
    spec = board(facing=pi - 0.3)
    expected = cells_seen(spec, AHEAD)
    bright = picture([spec], AHEAD, with_egl=True)[..., 0] > 90
    sure = expected >= 0
    for down, right in ((0, 1), (1, 0), (0, -1), (-1, 0)):
        sure &= np.roll(expected, (down, right), (0, 1)) == expected
    assert sure.sum() > 2000
    assert_array_equal(bright[sure], expected[sure] > 0)


@pytest.mark.parametrize("dictionary", sorted(DICTIONARIES))
@pytest.mark.parametrize("shape", ["board", "box", "cylinder"])
def test_opencv_reads_the_marker(shape: str, dictionary: str) -> None:
    number = DICTIONARIES[dictionary] - 1
    spec = board(shape=shape, dictionary=dictionary, marker=number, height=0.6)
    image = picture([spec], with_pin=Pin(640, 480, 600.0, 600.0, 319.5, 239.5))
    family = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, f"DICT_{dictionary}"))
    _, found, _ = cv2.aruco.ArucoDetector(family).detectMarkers(image)
    assert found is not None
    assert set(found.ravel().tolist()) == {number}


def test_a_lamp_follows_its_period_duty_and_phase() -> None:
    lamp = FlashSpec(period=0.4, duty=0.25, phase=0.5)
    moments = [0.0, 0.19, 0.2, 0.29, 0.3, 0.59, 0.6]
    assert [lamp.lit(round(t * SECOND)) for t in moments] == [False, False, True, True, False, False, True]


def test_a_lamp_that_is_off_is_dark_and_no_beacon_in_the_labels_but_still_hides() -> None:
    near = BeaconSpec(at=(2.0, 0.0), colour="green", flash=FlashSpec(period=1.0, duty=0.5))
    far = BeaconSpec(at=(4.0, 0.0), colour="red", foot_radius=0.02, top_radius=0.02)
    camera = BulletRenderer(SKEWED, Scenery([near, far]), Cost())
    for t, labels, green in ((0, {0, 1}, 255), (SECOND // 2, {0}, 25), (SECOND, {0, 1}, 255)):
        assert set(np.unique(camera.labels(AHEAD, t))) == labels
        image = camera.render(AHEAD, t)
        assert {tuple(one) for one in image.reshape(-1, 3).tolist()} == {(255, 255, 255), (0, green, 0)}
    camera.close()


def test_a_walk_goes_to_and_fro_at_its_speed() -> None:
    walk = Walk(((0.0, 0.0), (3.0, 0.0), (3.0, 4.0)), 2.0)
    for t, expected in (
        (0.0, (0, 0)),
        (1.0, (2, 0)),
        (2.5, (3, 2)),
        (3.5, (3, 4)),
        (4.5, (3, 2)),
        (7.0, (0, 0)),
    ):
        assert_allclose(walk.at(round(t * SECOND))[:2], expected, atol=1e-9)
    assert walk.at(SECOND)[2] == 0.0
    assert walk.at(round(4.5 * SECOND))[2] == pytest.approx(-pi / 2)


def test_a_closed_walk_comes_back_the_short_way() -> None:
    walk = Walk(((0.0, 0.0), (3.0, 0.0), (3.0, 4.0)), 1.0, closed=True)
    assert_allclose(walk.at(12 * SECOND)[:2], (0.0, 0.0), atol=1e-9)
    x, y, _ = walk.at(10 * SECOND)
    assert (x, y) == pytest.approx((1.2, 1.6))
    steps = [walk.at(k * SECOND // 10) for k in range(240)]
    assert max(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(steps)) <= 0.1 + 1e-9


def test_somebody_who_walks_by_hides_a_beacon_for_as_long_as_he_is_before_it() -> None:
    passer = ObjectSpec(shape="cylinder", width=0.5, height=1.8, path=[(1.0, -2.0), (1.0, 2.0)], speed=1.0)
    beacon = BeaconSpec(at=(3.0, 0.0))
    camera = BulletRenderer(SKEWED, Scenery([beacon], around=ScenerySpec(objects=[passer])), Cost())
    seen = [bool(camera.labels(AHEAD, k * SECOND // 10).any()) for k in range(80)]
    camera.close()
    hidden = [k for k, one in enumerate(seen) if not one]
    assert {18, 20, 22, 58, 60, 62} <= set(hidden)  # at t = 2 s there, at t = 6 s back
    assert not {k for k in hidden if min(abs(k - 20), abs(k - 60)) > 4}


def test_what_is_no_beacon_has_no_label_whatever_its_colour() -> None:
    lure = ObjectSpec(shape="cone", at=(2.0, 0.0), colour=(1.0, 0.0, 0.0), width=0.14)
    camera = BulletRenderer(SKEWED, Scenery([], around=ScenerySpec(objects=[lure])), Cost())
    assert (camera.render(AHEAD, 0)[..., 1] < 100).any()
    assert not camera.labels(AHEAD, 0).any()
    camera.close()


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        ({"shape": "cone", "marker": 3}, "carries no marker"),
        ({"shape": "board", "marker": 50, "height": 1.0}, "markers 0…49, not 50"),
        ({"shape": "sphere", "height": 0.1}, "less than the width"),
        ({"flash": {"period": 0.0}}, "greater than"),
        ({"shape": "pyramid"}, "Input should be"),
    ],
    ids=["cone", "number", "sphere", "period", "shape"],
)
def test_a_beacon_that_cannot_be_is_refused(bad: dict[str, object], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        BeaconSpec.model_validate({"at": (1.0, 0.0), **bad})
