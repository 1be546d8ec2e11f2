"""What the renderer loads for each beacon and each other thing: a mesh, its colour and how it moves."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

import cv2
import numpy as np

from hilbed.scene import COLOURS, BeaconSpec, Colour, FlashSpec, ObjectSpec
from hilbed.types import Image
from hilbed.vision import meshes
from hilbed.vision.meshes import Mesh
from hilbed.vision.opengl import Vector
from hilbed.vision.walk import Walk

_WHITE: Colour = (1.0, 1.0, 1.0)


class Turn(Enum):
    """What a thing turns to the camera: nothing, its front, or its front at the camera's height."""

    STILL = "still"
    YAW = "yaw"
    AIM = "aim"


class Part(NamedTuple):
    """A body: mesh, colour, place (m, map), yaw (rad) if it stands still, texture, lamp, way that it goes."""

    mesh: Mesh
    colour: Colour
    at: Vector
    turn: Turn
    yaw: float = 0.0
    texture: Image | None = None
    flash: FlashSpec | None = None
    walk: Walk | None = None


def of_beacon(spec: BeaconSpec) -> Part:
    """Returns what is drawn of a beacon."""
    lift = spec.height - spec.foot_radius if spec.shape == "sphere" else 0.0
    turn = Turn.YAW if spec.facing is None else Turn.STILL
    return Part(
        _beacon_mesh(spec),
        COLOURS[spec.colour] if spec.marker is None else _WHITE,
        (*spec.at, lift),
        Turn.AIM if spec.shape == "sphere" else turn,
        spec.facing or 0.0,
        None if spec.marker is None else marker_texture(spec.dictionary, spec.marker),
        spec.flash,
    )


def of_object(spec: ObjectSpec) -> Part:
    """Returns what is drawn of anything else."""
    sphere = spec.shape == "sphere"
    lift = spec.lift + (spec.width / 2.0 if sphere else 0.0)
    walk = Walk(tuple(spec.path), spec.speed, spec.closed) if spec.path else None
    turn = Turn.AIM if sphere else Turn.STILL
    return Part(_object_mesh(spec), spec.colour, (*spec.at, lift), turn, spec.yaw, walk=walk)


def marker_texture(dictionary: str, marker: int) -> Image:
    """Returns (n, n) one pixel a cell, black 0 and white 255, with a white margin of one cell."""
    family = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, f"DICT_{dictionary}"))
    cells = cv2.aruco.generateImageMarker(family, marker, family.markerSize + 2)
    return np.pad(np.asarray(cells, np.uint8), 1, constant_values=255)


def _beacon_mesh(spec: BeaconSpec) -> Mesh:
    radius, height = spec.foot_radius, spec.height
    low = 0.0 if spec.marker is None else height - 2.0 * radius
    marked = spec.marker is not None
    match spec.shape:
        case "sphere":
            return meshes.sphere(radius)
        case "board":
            return meshes.board(radius, low, height)
        case "box":
            return meshes.marked_box(radius, low, height)
        case "cylinder" if marked:
            return meshes.marked_cylinder(radius, low, height)
    half = meshes.HALF_CONE if spec.shape == "cone" else meshes.ROUND // 2
    return meshes.frustum(radius, spec.upper_radius, height, 2 * half, half)


def _object_mesh(spec: ObjectSpec) -> Mesh:
    radius = spec.width / 2.0
    match spec.shape:
        case "box":
            return meshes.box(spec.width if spec.depth is None else spec.depth, spec.width, spec.height)
        case "sphere":
            return meshes.sphere(radius)
        case "cylinder":
            return meshes.frustum(radius, radius, spec.height)
        case "cone":
            return meshes.frustum(radius, 0.4 * radius, spec.height)
