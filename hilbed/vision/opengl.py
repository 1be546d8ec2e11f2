"""OpenGL's matrices of a camera whose pixels are counted as OpenCV counts them."""

from __future__ import annotations

from math import cos, sin
from typing import Protocol, TypeAlias

from hilbed.vision.seams import Viewpoint

NEAR, FAR = 0.02, 200.0

Matrix: TypeAlias = tuple[float, ...]
Vector: TypeAlias = tuple[float, float, float]


class Pinhole(Protocol):
    """A camera without distortion, in pixels: size, focal lengths and principal point, as in OpenCV.

    Pixel (0, 0) is the centre of the upper left pixel.
    """

    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def fx(self) -> float: ...
    @property
    def fy(self) -> float: ...
    @property
    def cx(self) -> float: ...
    @property
    def cy(self) -> float: ...


def axes(view: Viewpoint) -> tuple[Vector, Vector, Vector]:
    """Returns where a camera's forward, left and up point in the map: Rz(yaw) Ry(pitch) Rx(roll)."""
    cy, sy = cos(view.yaw), sin(view.yaw)
    cp, sp = cos(view.pitch), sin(view.pitch)
    cr, sr = cos(view.roll), sin(view.roll)
    return (
        (cy * cp, sy * cp, -sp),
        (cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr),
        (cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr),
    )


def look(view: Viewpoint) -> Matrix:
    """Returns OpenGL's 4×4 view matrix, column by column."""
    (fx, fy, fz), (lx, ly, lz), (ux, uy, uz) = axes(view)
    x, y, z = view.x, view.y, view.z
    return (
        -lx, ux, -fx, 0.0,
        -ly, uy, -fy, 0.0,
        -lz, uz, -fz, 0.0,
        lx * x + ly * y + lz * z, -(ux * x + uy * y + uz * z), fx * x + fy * y + fz * z, 1.0,
    )  # fmt: skip


def projection(lens: Pinhole, edges: tuple[float, float]) -> Matrix:
    """Returns OpenGL's 4×4 projection matrix, column by column.

    edges: column of the frustum's left and row of its upper edge, in pixels of OpenCV's convention.
    """
    column, row = edges
    left, right = (column - lens.cx) / lens.fx, (column + lens.width - lens.cx) / lens.fx
    top, bottom = (lens.cy - row) / lens.fy, (lens.cy - row - lens.height) / lens.fy
    depth = FAR - NEAR
    return (
        2.0 / (right - left), 0.0, 0.0, 0.0,
        0.0, 2.0 / (top - bottom), 0.0, 0.0,
        (right + left) / (right - left), (top + bottom) / (top - bottom), -(FAR + NEAR) / depth, -1.0,
        0.0, 0.0, -2.0 * FAR * NEAR / depth, 0.0,
    )  # fmt: skip
