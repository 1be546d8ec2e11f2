"""The shape of a beacon for the renderer: the half of a truncated cone that faces the camera."""

from __future__ import annotations

from math import cos, pi, sin

from hilbed.scene import BeaconSpec

FACETS = 4


def obj(beacon: BeaconSpec) -> str:
    """Returns the mesh (m) as a Wavefront OBJ file, its axis along z, its open side towards −x.

    The renderer turns it about its axis to face the camera. Then its outline is that of a round cone, and
    symmetric about the axis, with few triangles; 24 sides at rest would be off by up to 6 mdeg at 2 m.
    """
    directions = [pi * (k / FACETS - 0.5) for k in range(FACETS + 1)]
    foot = [(beacon.foot_radius * cos(a), beacon.foot_radius * sin(a), 0.0) for a in directions]
    top = [(beacon.top_radius * cos(a), beacon.top_radius * sin(a), beacon.height) for a in directions]
    count = len(foot)
    faces = [(k, k + 1, count + k + 1, count + k) for k in range(1, count)]
    lid = tuple(range(count + 1, 2 * count + 1))
    vertices = "".join(f"v {x:.9f} {y:.9f} {z:.9f}\n" for x, y, z in foot + top)
    return vertices + "".join(f"f {' '.join(map(str, face))}\n" for face in (*faces, lid))
