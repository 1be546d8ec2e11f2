"""Draws the beacons as a camera sees them, in a PyBullet client of its own that holds nothing else."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from math import atan2, cos, sin
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, TypeAlias
from weakref import finalize

import cv2
import numpy as np

from hilbed.cost import Cost, perf_counter
from hilbed.quiet import muted
from hilbed.scene import COLOURS, BeaconSpec, Colour
from hilbed.types import Image, Nanos, ScenarioError
from hilbed.vision import egl
from hilbed.vision.cone import obj
from hilbed.vision.opengl import FAR, Pinhole, look, projection
from hilbed.vision.seams import Viewpoint

with muted():
    import pybullet

Quiet: TypeAlias = Callable[[], AbstractContextManager[None]]

GROUND: Colour = (0.6, 0.6, 0.6)
_SQUARE = f"v {-FAR} {-FAR} 0\nv {FAR} {-FAR} 0\nv {FAR} {FAR} 0\nv {-FAR} {FAR} 0\nf 1 2 3 4\n"

# OpenCV's coordinates of the frustum's left and upper edge: TinyRenderer samples a pixel at its left edge
# and draws one row higher than OpenGL, which samples in the middle.
_TINY_EDGES = (0.0, -1.0)
_EGL_EDGES = (-0.5, -0.5)

_TINY = {"renderer": pybullet.ER_TINY_RENDERER}
# Flat, exact colours: what the detector gets is the colour of the beacon.
_LIGHT = {"shadow": 0, "lightAmbientCoeff": 1.0, "lightDiffuseCoeff": 0.0, "lightSpecularCoeff": 0.0}


@dataclass(frozen=True)
class Scenery:
    """What is drawn, and by which renderer: ground makes a frame three times as dear."""

    beacons: Sequence[BeaconSpec]
    egl: bool = False
    ground: bool = False


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
        self._finalize = finalize(self, _disconnect, self._client, self._quiet)
        if scenery.egl:
            egl.load(self._client)
        self._projection = projection(lens, _EGL_EDGES if scenery.egl else _TINY_EDGES)
        self._beacons = self._load(scenery)
        self._label = _labels([body for body, *_ in self._beacons])

    def render(self, view: Viewpoint, t: Nanos) -> Image:
        """Returns (H, W, 3) RGB as seen from `view` at t."""
        rgba = self._picture(view, t, pybullet.ER_NO_SEGMENTATION_MASK)[2]
        image = np.asarray(rgba, np.uint8).reshape(self._lens.height, self._lens.width, 4)
        return np.asarray(cv2.cvtColor(image, cv2.COLOR_RGBA2RGB), np.uint8)

    def labels(self, view: Viewpoint, t: Nanos) -> Image:
        """Returns (H, W): 0 where no beacon is seen, k + 1 where that of index k is."""
        bodies = np.asarray(self._picture(view, t, 0)[4]).reshape(self._lens.height, self._lens.width)
        return self._label[bodies + 1]

    def close(self) -> None:
        """Gives the client back; further frames are an error."""
        self._finalize()

    def _picture(self, view: Viewpoint, t: Nanos, flags: int) -> Any:  # noqa: ARG002
        """Returns what PyBullet sees: width, height, colours, depths, bodies."""
        client, lens, cost = self._client, self._lens, self._cost
        for body, x, y in self._beacons:
            half = 0.5 * atan2(view.y - y, view.x - x)
            pybullet.resetBasePositionAndOrientation(
                body, (x, y, 0.0), (0.0, 0.0, sin(half), cos(half)), physicsClientId=client
            )
        matrices = look(view), self._projection
        with self._quiet():
            start = perf_counter()
            picture = pybullet.getCameraImage(
                lens.width, lens.height, *matrices, **_LIGHT, **_TINY, flags=flags, physicsClientId=client
            )
            cost.render += perf_counter() - start
        return picture

    def _load(self, scenery: Scenery) -> list[tuple[int, float, float]]:
        """Returns body, x and y (m) of each beacon."""
        with TemporaryDirectory() as folder:
            file = Path(folder) / "ground.obj"
            if scenery.ground:
                self._body(file, _SQUARE, GROUND)
            bodies = []
            for index, beacon in enumerate(scenery.beacons):
                body = self._body(Path(folder) / f"{index}.obj", obj(beacon), COLOURS[beacon.colour])
                bodies.append((body, *beacon.at))
        return bodies

    def _body(self, file: Path, mesh: str, colour: Colour) -> int:
        """Loads a mesh by way of a file, since EGL crashes on one that comes as vertices."""
        file.write_text(mesh)
        shape = pybullet.createVisualShape(
            pybullet.GEOM_MESH, fileName=str(file), rgbaColor=(*colour, 1.0), physicsClientId=self._client
        )
        return int(pybullet.createMultiBody(baseVisualShapeIndex=shape, physicsClientId=self._client))


def _disconnect(client: int, quiet: Quiet) -> None:
    with quiet():
        pybullet.disconnect(client)


def _labels(bodies: Sequence[int]) -> Image:
    """Returns (n,) what each body is labelled as; the first is that of no body."""
    labels = np.zeros(max(bodies, default=-1) + 2, np.uint8)
    labels[[body + 1 for body in bodies]] = range(1, len(bodies) + 1)
    return labels
