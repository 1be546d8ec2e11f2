"""A camera without its detector: from where robot and camera were to an image, and to its truth."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, hypot, remainder, sin, tau
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hilbed import rng
from hilbed.clock import nanos
from hilbed.cost import Cost
from hilbed.scene import BeaconSpec
from hilbed.sensors.exposure import Exposure, Moment
from hilbed.sensors.eye import Setting
from hilbed.types import Image, Nanos
from hilbed.vision.chip import PERFECT, Chip, blocks, develop
from hilbed.vision.lens import Lens
from hilbed.vision.opengl import Pinhole
from hilbed.vision.seams import Renderer, Shot, ShotTruth, Viewpoint
from hilbed.vision.shutter import Shutter, collect, count, moments, shares
from hilbed.vision.truth import beacons_truth
from hilbed.vision.warp import mean

if TYPE_CHECKING:
    from hilbed.sensors.camera import CameraSpec

_NEAR = 1.0  # m: what is farther moves by less than a pixel from one image of an exposure to the next


class Place(NamedTuple):
    """A camera on its robot: optical centre (m, robot's frame) and lens."""

    mount: tuple[float, float, float]
    lens: Lens


class Film(NamedTuple):
    """What makes an image of light: shutter, chip, and the stream of its noise (seed, name)."""

    shutter: Shutter = Shutter()
    chip: Chip = PERFECT
    stream: tuple[int, str] = (0, "camera")


class Imager:
    """Exposes frames; what a frame shows depends on the exposure alone, not on the frames before."""

    def __init__(self, place: Place, renderer: Renderer, film: Film = Film()) -> None:  # noqa: B008
        self._mount, self.lens = place
        self._renderer, self._film = renderer, film

    def shoot(self, exposure: Exposure) -> Shot:
        """Returns the image that an exposure gives."""
        film, images = self._film, self._images(exposure)
        if len(images) == 1 and film.chip == PERFECT:
            return Shot(images[0], exposure.t, self.lens)
        random = rng.stream(*film.stream, exposure.t) if film.chip.noisy else None
        image = np.empty_like(images[0])
        part = shares(film.shutter, len(images), self.lens.height)
        for rows in blocks(self.lens.height, self.lens.width):
            develop(collect(images, part, rows), rows.start, film.chip, random, image)
        return Shot(image, exposure.t, self.lens)

    def truth(self, exposure: Exposure, beacons: Sequence[BeaconSpec]) -> ShotTruth:
        """Returns the truth of a frame, which costs another image."""
        moment = exposure.at(exposure.t)
        view = self.viewpoint(moment)
        labels = self._renderer.labels(view, exposure.t)
        found = beacons_truth(beacons, view, moment.pan, self.lens, labels)
        return ShotTruth(exposure.t, view, moment.pose, found)

    def viewpoint(self, moment: Moment) -> Viewpoint:
        """Returns where the camera is and looks."""
        return viewpoint(self._mount, moment, self.lens)

    def close(self) -> None:
        """Gives back what the renderer holds."""
        self._renderer.close()

    def _images(self, exposure: Exposure) -> list[Image]:
        """Returns what is seen in equal parts of the exposure, or its mean where all rows see the same."""
        shutter, t = self._film.shutter, exposure.t
        images = count(shutter.fineness * self._motion(exposure)) if shutter.span else 1
        if images == 1:
            return [self._renderer.render(self.viewpoint(exposure.at(t)), t)]
        times = [t + nanos(late) for late in moments(shutter, images).tolist()]
        looks = [(self.viewpoint(exposure.at(one)), one) for one in times]
        parts = [[look] for look in looks] if shutter.readout else [looks]
        return [mean(self._renderer, part) for part in parts]

    def _motion(self, exposure: Exposure) -> float:
        """Returns by how many pixels the camera's motion moves what it sees."""
        half: Nanos = nanos(self._film.shutter.span / 2.0)
        begin, end = exposure.at(exposure.t - half), exposure.at(exposure.t + half)
        turn = remainder(end.pose.yaw - begin.pose.yaw, tau) + end.pan - begin.pan
        way = hypot(end.pose.x - begin.pose.x, end.pose.y - begin.pose.y)
        return self.lens.fx * (abs(turn) + way / _NEAR)


def viewpoint(mount: tuple[float, float, float], moment: Moment, lens: Lens) -> Viewpoint:
    """Returns where a camera on `mount` (m, robot's frame) is and looks."""
    forward, left, height = mount
    (x, y, yaw), pan = moment.pose, moment.pan
    c, s = cos(yaw), sin(yaw)
    at = (x + c * forward - s * left, y + s * forward + c * left, height)
    return Viewpoint(*at, yaw + pan, lens.tilt, lens.roll)


def open_imager(spec: CameraSpec, setting: Setting, cost: Cost) -> Imager:
    """Returns the camera of a scenario; raises ScenarioError where the renderer does not work."""
    from hilbed.scene.chance import seeded
    from hilbed.vision.render import BulletRenderer, Scenery
    from hilbed.vision.warp import Warped

    around = seeded(setting.scenery, setting.seed)
    scenery = Scenery(setting.beacons, spec.renderer == "egl", spec.ground, around)

    def make(pinhole: Pinhole) -> Renderer:
        return BulletRenderer(pinhole, scenery, cost)

    lens = spec.lens
    renderer = Warped(lens, make) if lens.distorted else make(lens)
    chip = Chip(spec.vignetting, spec.shot_noise, spec.read_noise, spec.gain, spec.gamma, spec.bits)
    film = Film(Shutter(spec.exposure, spec.readout), chip, (setting.seed, f"sensors.{setting.name}.pixels"))
    return Imager(Place(spec.mount, lens), renderer, film)
