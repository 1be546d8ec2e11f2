"""Draws the beacons as a camera sees them, in a PyBullet client of its own that holds nothing else."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from typing import Any, TypeAlias
from weakref import finalize

import cv2
import numpy as np

from hilbed.cost import Cost, perf_counter
from hilbed.quiet import muted
from hilbed.scene import BeaconSpec, FloorSpec, ScenerySpec
from hilbed.scene.chance import made_up
from hilbed.types import Image, Nanos, ScenarioError
from hilbed.vision import egl
from hilbed.vision.backdrop import Backdrop
from hilbed.vision.light import Glare, bullet
from hilbed.vision.opengl import Pinhole, look, projection
from hilbed.vision.parts import of_beacon, of_object
from hilbed.vision.seams import Viewpoint
from hilbed.vision.stage import Stage

with muted():
    import pybullet

Quiet: TypeAlias = Callable[[], AbstractContextManager[None]]

NOTHING = ScenerySpec()
_EGL_CELL = 32  # pixels a cell of a marker: EGL blurs between pixels, TinyRenderer takes the nearest

# OpenCV's coordinates of the frustum's left and upper edge: TinyRenderer samples a pixel at its left edge
# and draws one row higher than OpenGL, which samples in the middle.
_TINY_EDGES = (0.0, -1.0)
_EGL_EDGES = (-0.5, -0.5)

_TINY = {"renderer": pybullet.ER_TINY_RENDERER}


@dataclass(frozen=True)
class Scenery:
    """What is drawn, and by which renderer; ground: a grey floor where the scenery has none."""

    beacons: Sequence[BeaconSpec]
    egl: bool = False
    ground: bool = False
    around: ScenerySpec = NOTHING

    def surroundings(self) -> ScenerySpec:
        """Returns what is to be drawn besides the beacons, all of it stated."""
        around = made_up(self.around, self.beacons)
        if self.ground and around.floor is None:
            return around.model_copy(update={"floor": FloorSpec()})
        return around


class BulletRenderer:
    """Renders beacons with TinyRenderer, or with EGL where the scenery asks for it.

    Principal point and pixel centres are those of `Lens` with either. Raises ScenarioError where EGL does
    not work or is too small. Several renderers may live in one process.
    """

    def __init__(self, lens: Pinhole, scenery: Scenery, cost: Cost) -> None:
        if scenery.egl:
            egl.require(lens)
        self._lens = lens
        self._cost = cost
        self._client = pybullet.connect(pybullet.DIRECT)
        if self._client < 0:
            raise ScenarioError("PyBullet has no client left for the camera: too many cameras in one process")
        self._quiet: Quiet = egl.silence if scenery.egl else nullcontext  # EGL prints as it draws
        self._finalize = finalize(self, egl.release if scenery.egl else pybullet.disconnect, self._client)
        if scenery.egl:
            egl.load(self._client)
        self._projection = projection(lens, _EGL_EDGES if scenery.egl else _TINY_EDGES)
        around = scenery.surroundings()
        beacons, others = map(of_beacon, scenery.beacons), map(of_object, around.objects)
        self._stage = Stage(self._client, list(beacons), list(others), _EGL_CELL if scenery.egl else 1)
        self._backdrop = None if around == NOTHING else Backdrop(lens, around, scenery.beacons)
        self._glare = Glare(lens, around.light)
        self._light = bullet(around.light)

    def render(self, view: Viewpoint, t: Nanos) -> Image:
        """Returns (H, W, 3) RGB as seen from `view` at t."""
        _, _, rgba, depths, _ = self._picture(view, t, pybullet.ER_NO_SEGMENTATION_MASK)
        shape = (self._lens.height, self._lens.width)
        bodies = _rgb(np.asarray(rgba, np.uint8).reshape(*shape, 4))
        if self._backdrop is None:
            return bodies
        solid = (np.asarray(depths, np.float32).reshape(shape) < 1.0).view(np.uint8)
        image = np.asarray(cv2.copyTo(bodies, solid, self._backdrop.paint(view)), np.uint8)
        return image if self._glare.plain else self._glare.over(image, view)

    def labels(self, view: Viewpoint, t: Nanos) -> Image:
        """Returns (H, W): 0 where no beacon is seen, k + 1 where that of index k is."""
        bodies = np.asarray(self._picture(view, t, 0)[4]).reshape(self._lens.height, self._lens.width)
        return self._stage.labels(bodies)

    def close(self) -> None:
        """Gives the client back; further frames are an error."""
        self._finalize()

    def _picture(self, view: Viewpoint, t: Nanos, flags: int) -> Any:
        """Returns what PyBullet sees: width, height, colours, depths, bodies."""
        client, lens, cost = self._client, self._lens, self._cost
        self._stage.set(view, t)
        matrices = look(view), self._projection
        with self._quiet():
            start = perf_counter()
            picture = pybullet.getCameraImage(
                lens.width, lens.height, *matrices, **self._light, **_TINY,
                flags=flags, physicsClientId=client,
            )  # fmt: skip
            cost.render += perf_counter() - start
        return picture


def _rgb(rgba: Image) -> Image:
    return np.asarray(cv2.cvtColor(rgba, cv2.COLOR_RGBA2RGB), np.uint8)
