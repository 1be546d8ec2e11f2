"""Draws the beacons as a level camera sees them, in a PyBullet client of its own that holds nothing else."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from math import atan2, cos, sin
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TypeAlias
from weakref import finalize

import cv2
import numpy as np

from hilbed.cost import Cost, perf_counter
from hilbed.quiet import muted
from hilbed.scene import COLOURS, BeaconSpec, Colour
from hilbed.types import Image, ScenarioError
from hilbed.vision import egl
from hilbed.vision.cone import obj
from hilbed.vision.lens import Lens

with muted():
    import pybullet

Quiet: TypeAlias = Callable[[], AbstractContextManager[None]]

NEAR, FAR = 0.02, 200.0
GROUND: Colour = (0.6, 0.6, 0.6)
_SQUARE = f"v {-FAR} {-FAR} 0\nv {FAR} {-FAR} 0\nv {FAR} {FAR} 0\nv {-FAR} {FAR} 0\nf 1 2 3 4\n"

# OpenCV's coordinates of the frustum's left and upper edge: TinyRenderer samples a pixel at its left edge
# and draws one row higher than OpenGL, which samples in the middle.
_TINY_EDGES = (0.0, -1.0)
_EGL_EDGES = (-0.5, -0.5)

_FAST = {"renderer": pybullet.ER_TINY_RENDERER, "flags": pybullet.ER_NO_SEGMENTATION_MASK}
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

    def __init__(self, lens: Lens, scenery: Scenery, cost: Cost) -> None:
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

    def render(self, x: float, y: float, z: float, yaw: float) -> Image:
        """Returns (H, W, 3) RGB as seen from x, y, z (m, map) along `yaw` (rad, map)."""
        client, lens, cost = self._client, self._lens, self._cost
        for body, bx, by in self._beacons:
            half = 0.5 * atan2(y - by, x - bx)
            pybullet.resetBasePositionAndOrientation(
                body, (bx, by, 0.0), (0.0, 0.0, sin(half), cos(half)), physicsClientId=client
            )
        view = look(x, y, z, yaw)
        with self._quiet():
            start = perf_counter()
            picture = pybullet.getCameraImage(
                lens.width, lens.height, view, self._projection, **_LIGHT, **_FAST, physicsClientId=client
            )
            cost.render += perf_counter() - start
        rgba = np.asarray(picture[2], np.uint8).reshape(lens.height, lens.width, 4)
        return np.asarray(cv2.cvtColor(rgba, cv2.COLOR_RGBA2RGB), np.uint8)

    def close(self) -> None:
        """Gives the client back; further frames are an error."""
        self._finalize()

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


def look(x: float, y: float, z: float, yaw: float) -> tuple[float, ...]:
    """Returns OpenGL's 4×4 view matrix, column by column: level, at x, y, z (m), along yaw (rad)."""
    c, s = cos(yaw), sin(yaw)
    return (
        s, 0.0, -c, 0.0,
        -c, 0.0, -s, 0.0,
        0.0, 1.0, 0.0, 0.0,
        c * y - s * x, -z, c * x + s * y, 1.0,
    )  # fmt: skip


def projection(lens: Lens, edges: tuple[float, float]) -> tuple[float, ...]:
    """Returns OpenGL's 4×4 projection matrix, column by column.

    edges: column of the frustum's left and row of its upper edge, in pixels of OpenCV's convention.
    """
    column, row = edges
    left, right = (column - lens.cx) / lens.focal, (column + lens.width - lens.cx) / lens.focal
    top, bottom = (lens.cy - row) / lens.focal, (lens.cy - row - lens.height) / lens.focal
    depth = FAR - NEAR
    return (
        2.0 / (right - left), 0.0, 0.0, 0.0,
        0.0, 2.0 / (top - bottom), 0.0, 0.0,
        (right + left) / (right - left), (top + bottom) / (top - bottom), -(FAR + NEAR) / depth, -1.0,
        0.0, 0.0, -2.0 * FAR * NEAR / depth, 0.0,
    )  # fmt: skip
