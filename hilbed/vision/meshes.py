"""Shapes for the renderer: few triangles, their foot at z = 0, their front towards +x."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from math import cos, pi, sin
from typing import NamedTuple

from hilbed.vision.opengl import Vector

HALF_CONE = 4  # facets of the half that faces the camera
ROUND = 24  # sides of what is drawn all around

_WHITE = (0.02, 0.02)  # in the margin of every marker's texture


class Mesh(NamedTuple):
    """Vertices (m), faces as indices of them, counter-clockwise from outside; u, v of each vertex."""

    vertices: list[Vector]
    faces: list[tuple[int, ...]]
    uv: list[tuple[float, float]] = []


def obj(mesh: Mesh) -> str:
    """Returns a Wavefront OBJ file."""
    lines = [f"v {x:.9f} {y:.9f} {z:.9f}" for x, y, z in mesh.vertices]
    lines += [f"vt {u:.9f} {v:.9f}" for u, v in mesh.uv]
    corner = "{0}/{0}" if mesh.uv else "{0}"
    lines += ["f " + " ".join(corner.format(k + 1) for k in face) for face in mesh.faces]
    return "\n".join(lines) + "\n"


def frustum(foot: float, top: float, height: float, sides: int = ROUND, drawn: int = ROUND) -> Mesh:
    """Returns a truncated cone with a lid, of which the first `drawn` of its sides from −90° on are drawn.

    The half that faces the camera is enough: its outline is that of a round cone, and symmetric about the
    axis, with few triangles; 24 sides at rest would be off by up to 6 mdeg at 2 m.
    """
    turns = [2.0 * pi * k / sides - pi / 2.0 for k in range(sides)]
    low = [(foot * cos(a), foot * sin(a), 0.0) for a in turns]
    high = [(top * cos(a), top * sin(a), height) for a in turns]
    faces = [(k, (k + 1) % sides, sides + (k + 1) % sides, sides + k) for k in range(drawn)]
    return Mesh(low + high, [*faces, tuple(range(sides, 2 * sides))])


def sphere(radius: float, rings: int = 6) -> Mesh:
    """Returns a sphere about the origin from its pole at +x to its equator (6 rings) or beyond."""
    polar = [0.5 * pi * k / 6 for k in range(1, rings + 1)]
    turns = [2.0 * pi * k / ROUND for k in range(ROUND)]
    vertices = [(radius, 0.0, 0.0)]
    vertices += [
        (radius * cos(p), radius * sin(p) * cos(a), radius * sin(p) * sin(a)) for p in polar for a in turns
    ]
    faces: list[tuple[int, ...]] = [(0, 1 + k, 1 + (k + 1) % ROUND) for k in range(ROUND)]
    for ring in range(len(polar) - 1):
        inner, outer = 1 + ring * ROUND, 1 + (ring + 1) * ROUND
        for k in range(ROUND):
            after = (k + 1) % ROUND
            faces.append((inner + k, outer + k, outer + after, inner + after))
    return Mesh(vertices, faces)


def box(depth: float, width: float, height: float) -> Mesh:
    """Returns a box without a bottom."""
    x, y = depth / 2.0, width / 2.0
    ring = [(x, -y), (x, y), (-x, y), (-x, -y)]
    vertices = [(*corner, z) for z in (0.0, height) for corner in ring]
    return Mesh(vertices, [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)])


def board(half: float, low: float, high: float) -> Mesh:
    """Returns a rectangle in the plane x = 0 that shows its texture towards +x and a blank towards −x."""
    front = [(0.0, -half, low), (0.0, half, low), (0.0, half, high), (0.0, -half, high)]
    return Mesh(front + front, [(0, 1, 2, 3), (7, 6, 5, 4)], [*_corners(0.0, 1.0), *[_WHITE] * 4])


def marked_box(half: float, low: float, high: float) -> Mesh:
    """Returns a box that shows the whole texture on each of its four sides."""
    ring = [pi / 2.0 * k - pi / 4.0 for k in range(5)]
    return _band(((2.0**0.5 * half, a) for a in ring), low, high, repeat=1)


def marked_cylinder(radius: float, low: float, high: float) -> Mesh:
    """Returns a cylinder that shows the whole texture three times around, once in front."""
    ring = [2.0 * pi * k / ROUND - pi / 3.0 for k in range(ROUND + 1)]
    return _band(((radius, a) for a in ring), low, high, repeat=ROUND // 3)


def _band(ring: Iterable[tuple[float, float]], low: float, high: float, repeat: int) -> Mesh:
    """Returns upright faces between points (radius, angle), and a lid; the texture spans `repeat` faces."""
    points = [(r * cos(a), r * sin(a)) for r, a in ring]
    mesh = Mesh([], [], [])
    for k, (one, other) in enumerate(pairwise(points)):
        first = len(mesh.vertices)
        mesh.vertices.extend([(*one, low), (*other, low), (*other, high), (*one, high)])
        mesh.faces.append((first, first + 1, first + 2, first + 3))
        mesh.uv.extend(_corners(k % repeat / repeat, (k % repeat + 1) / repeat))
    mesh.faces.append(tuple(range(len(mesh.vertices), len(mesh.vertices) + len(points) - 1)))
    mesh.vertices.extend((*point, high) for point in points[:-1])
    mesh.uv.extend([_WHITE] * (len(points) - 1))
    return mesh


def _corners(left: float, right: float) -> list[tuple[float, float]]:
    return [(left, 0.0), (right, 0.0), (right, 1.0), (left, 1.0)]
