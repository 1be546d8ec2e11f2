"""The bodies in the renderer's PyBullet client: loads them, then turns, moves and lights them for a frame."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, hypot, sin
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np

from hilbed.quiet import muted
from hilbed.types import Image, Nanos
from hilbed.vision.meshes import obj
from hilbed.vision.parts import Part, Turn
from hilbed.vision.seams import Viewpoint

with muted():
    import pybullet

UNLIT = 0.1
"""Brightness of a lamp that is off."""


class Stage:
    """Beacons and everything else that may hide them.

    beacons, others: what to load into the client; fine: pixels a cell of a texture, 1 where the renderer
    takes the nearest pixel of it, more where it blurs them.
    """

    def __init__(self, client: int, beacons: Sequence[Part], others: Sequence[Part], fine: int) -> None:
        self._client = client
        with TemporaryDirectory() as folder:
            parts = [
                (_load(client, part, Path(folder) / f"{index}.obj", fine), part)
                for index, part in enumerate((*beacons, *others))
            ]
        self._turning = [(body, *part.at) for body, part in parts if part.turn is Turn.YAW]
        self._aimed = [(body, part) for body, part in parts if part.turn is Turn.AIM]
        self._walking = [(body, part) for body, part in parts if part.walk is not None]
        self._flashing = [(k, *one) for k, one in enumerate(parts) if one[1].flash is not None]
        self._lit = {body: True for _, body, _ in self._flashing}
        self._labels = np.zeros(len(parts) + 1, np.uint8)
        self._labels[[body + 1 for body, _ in parts[: len(beacons)]]] = range(1, len(beacons) + 1)

    def set(self, view: Viewpoint, t: Nanos) -> None:
        """Puts everything where the camera sees it at t."""
        client = self._client
        for body, x, y, z in self._turning:
            half = 0.5 * atan2(view.y - y, view.x - x)
            pybullet.resetBasePositionAndOrientation(
                body, (x, y, z), (0.0, 0.0, sin(half), cos(half)), physicsClientId=client
            )
        for body, part in self._walking:
            self._walk(body, part, t)
        for body, part in self._aimed:
            self._aim(body, part, view, t)
        for _, body, part in self._flashing:
            self._light(body, part, t)

    def labels(self, bodies: Image) -> Image:
        """Returns what to call each body of the picture: k + 1 a beacon that is lit, 0 anything else."""
        labels = self._labels
        for index, body, _ in self._flashing:
            labels[body + 1] = index + 1 if self._lit[body] else 0
        return labels[bodies + 1]

    def _walk(self, body: int, part: Part, t: Nanos) -> None:
        if part.walk is not None:
            x, y, yaw = part.walk.at(t)
            self._place(body, (x, y, part.at[2]), (0.0, 0.0, yaw))

    def _aim(self, body: int, part: Part, view: Viewpoint, t: Nanos) -> None:
        x, y, z = part.at
        if part.walk is not None:
            x, y, _ = part.walk.at(t)
        dx, dy, dz = view.x - x, view.y - y, view.z - z
        self._place(body, (x, y, z), (0.0, -atan2(dz, hypot(dx, dy)), atan2(dy, dx)))

    def _place(self, body: int, at: tuple[float, ...], turn: tuple[float, ...]) -> None:
        quaternion = pybullet.getQuaternionFromEuler(turn)
        pybullet.resetBasePositionAndOrientation(body, at, quaternion, physicsClientId=self._client)

    def _light(self, body: int, part: Part, t: Nanos) -> None:
        lit = part.flash is None or part.flash.lit(t)
        if lit == self._lit[body]:
            return
        self._lit[body] = lit
        colour = [(1.0 if lit else UNLIT) * channel for channel in part.colour]
        pybullet.changeVisualShape(body, -1, rgbaColor=(*colour, 1.0), physicsClientId=self._client)


def _load(client: int, part: Part, file: Path, fine: int) -> int:
    """Loads a body by way of a file, since EGL crashes on a mesh that comes as vertices."""
    file.write_text(obj(part.mesh))
    shape = pybullet.createVisualShape(
        pybullet.GEOM_MESH, fileName=str(file), rgbaColor=(*part.colour, 1.0), physicsClientId=client
    )
    body = pybullet.createMultiBody(
        baseVisualShapeIndex=shape,
        basePosition=part.at,
        baseOrientation=pybullet.getQuaternionFromEuler((0.0, 0.0, part.yaw)),
        physicsClientId=client,
    )
    if part.texture is not None:
        image = file.with_suffix(".png")
        cv2.imwrite(str(image), np.kron(part.texture, np.ones((fine, fine), np.uint8)))
        texture = pybullet.loadTexture(str(image), physicsClientId=client)
        pybullet.changeVisualShape(body, -1, textureUniqueId=texture, physicsClientId=client)
    return int(body)
