"""Scenery from a seed."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from pydantic import TypeAdapter, ValidationError

from hilbed.cost import Cost
from hilbed.scene import BeaconSpec, FloorSpec, ObjectSpec, RandomSpec, SceneryBlock, ScenerySpec
from hilbed.scene.chance import made_up, seeded
from hilbed.scene.scenery import PRESETS, WallsSpec
from hilbed.types import Image
from hilbed.vision.render import BulletRenderer, Scenery
from hilbed.vision.seams import Viewpoint
from tests.vision.scenes import WIDE

BEACONS = [BeaconSpec(at=(4.0, 0.0)), BeaconSpec(at=(-4.0, 3.0), colour="green")]
BLOCK: TypeAdapter[ScenerySpec] = TypeAdapter(SceneryBlock)


def frame(scenery: ScenerySpec) -> Image:
    camera = BulletRenderer(WIDE, Scenery(BEACONS, around=scenery), Cost())
    image = camera.render(Viewpoint(0.0, 0.0, 0.3, 0.0), 0)
    camera.close()
    return image


def test_a_seed_gives_the_same_frame_again_and_another_a_different_one() -> None:
    spec = ScenerySpec(random=RandomSpec())
    first = frame(seeded(spec, 4))
    assert_array_equal(frame(seeded(spec, 4)), first)
    assert (frame(seeded(spec, 5)) != first).any()


def test_a_seed_of_its_own_counts_more_than_that_of_the_scenario() -> None:
    spec = ScenerySpec(random=RandomSpec(seed=9))
    assert seeded(spec, 4) == spec
    assert seeded(ScenerySpec(), 4) == ScenerySpec()


def test_what_is_made_up_is_stated_whole_and_may_be_written_down() -> None:
    spec = made_up(ScenerySpec(random=RandomSpec(seed=2)), BEACONS)
    assert spec.random is None
    again = ScenerySpec.model_validate_json(spec.model_dump_json())
    assert again == spec
    assert_array_equal(frame(again), frame(ScenerySpec(random=RandomSpec(seed=2))))


def test_what_is_stated_stays() -> None:
    thing, floor = ObjectSpec(at=(1.0, 1.0)), FloorSpec(pattern="wood")
    spec = ScenerySpec(objects=[thing], floor=floor, random=RandomSpec(seed=1, light=False))
    whole = made_up(spec, BEACONS)
    assert whole.objects[0] == thing
    assert (whole.floor, whole.light) == (floor, spec.light)
    assert len(whole.objects) == 1 + 6 + 4 + 2


@pytest.mark.parametrize("seed", range(5))
def test_everything_stands_between_the_walls_and_none_of_the_furniture_among_the_beacons(seed: int) -> None:
    whole = made_up(ScenerySpec(random=RandomSpec(seed=seed, boxes=30)), BEACONS)
    (x0, y0), (x1, y1) = WallsSpec().room([beacon.at for beacon in BEACONS])
    for thing in whole.objects:
        for x, y in thing.path or [thing.at]:
            assert x0 < x < x1
            assert y0 < y < y1
        if not thing.path:
            x, y = thing.at
            assert min(x - x0, x1 - x, y - y0, y1 - y) <= 0.7 * WallsSpec().margin


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_a_word_is_a_scenery(name: str) -> None:
    spec = BLOCK.validate_python(name)
    assert frame(spec).shape == (64, 640, 3)
    assert BLOCK.validate_json(spec.model_dump_json()) == spec


def test_the_default_is_nothing_at_all() -> None:
    assert BLOCK.validate_python("void") == ScenerySpec()
    colours = np.unique(frame(ScenerySpec()).reshape(-1, 3), axis=0).tolist()
    assert sorted(colours) == [[255, 0, 0], [255, 255, 255]]


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        ("desert", "none of void, arena"),
        ({"sky": "purple"}, "none of red"),
        ({"walls": {"corner": (0.0, 0.0)}}, "both corner and opposite"),
        ({"walls": {"corner": (1.0, 0.0), "opposite": (0.0, 1.0)}}, "beyond corner"),
        ({"objects": [{"path": [(0.0, 0.0)]}]}, "two points or more"),
        ({"objects": [{"path": [(1.0, 0.0), (1.0, 0.0)]}]}, "are the same"),
        ({"floor": {"pattern": "mud"}}, "pattern"),
        ({"light": {"veil": 1.5}}, "veil"),
    ],
    ids=["word", "colour", "corner", "corners", "path", "point", "pattern", "veil"],
)
def test_scenery_that_cannot_be_is_refused(bad: object, message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        BLOCK.validate_python(bad)
