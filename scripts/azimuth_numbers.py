"""Prints how exact the azimuths of rendered beacons are, by distance, and what a frame costs.

.venv/bin/python scripts/azimuth_numbers.py [WIDTH HEIGHT FOV_DEG [FRAMES]]
"""

from __future__ import annotations

import argparse
from math import atan2, cos, radians, sin
from time import perf_counter

import numpy as np

from hilbed.cost import Cost
from hilbed.scene import BeaconSpec
from hilbed.types import Array, ScenarioError
from hilbed.vision.detect import ColourDetector
from hilbed.vision.lens import Lens
from hilbed.vision.render import BulletRenderer, Scenery
from hilbed.vision.seams import Shot, Viewpoint

COLOURS = ("red", "orange", "green", "azure", "magenta", "yellow")
NEAREST, FARTHEST = 2.0, 8.0
FRAMES_A_SCENE = 10


def scene(lens: Lens, rng: np.random.Generator) -> list[BeaconSpec]:
    """Returns beacons side by side in front of the origin, at distances drawn from the range to test."""
    azimuths = lens.fov * (np.linspace(-0.42, 0.42, len(COLOURS)) + rng.uniform(-0.02, 0.02, len(COLOURS)))
    distances = rng.uniform(NEAREST, FARTHEST, len(COLOURS))
    return [
        BeaconSpec.model_validate({"at": (d * cos(a), d * sin(a)), "colour": colour})
        for a, d, colour in zip(azimuths, distances, COLOURS, strict=True)
    ]


def measure(lens: Lens, frames: int) -> tuple[Array, float, float]:
    """Returns rows of distance (m), error and stated std (rad), and s a frame in renderer and detector."""
    rng, cost, rows, detecting = np.random.default_rng(1), Cost(), [], 0.0
    for frame in range(frames):
        if frame % FRAMES_A_SCENE == 0:
            beacons = scene(lens, rng)
            camera, detector = BulletRenderer(lens, Scenery(beacons), cost), ColourDetector(lens, beacons)
        x, y, yaw = rng.uniform(-0.05, 0.05, 3).tolist()
        shot = Shot(camera.render(Viewpoint(x, y, rng.uniform(0.15, 0.5), yaw), 0), 0, lens)
        start = perf_counter()
        detections = detector.detect(shot)
        detecting += perf_counter() - start
        for found in detections:
            assert found.beacon is not None
            bx, by = beacons[found.beacon].at
            rows.append((np.hypot(bx - x, by - y), found.azimuth + yaw - atan2(by - y, bx - x), found.std))
    return np.array(rows), cost.render / frames, detecting / frames


def line(name: str, rows: Array) -> str:
    mdeg = 1e3 * np.degrees(rows[:, 1])
    trust = np.sqrt(np.mean((rows[:, 1] / rows[:, 2]) ** 2))
    return (
        f"{name:8} {len(rows):6} {mdeg.mean():9.2f} {mdeg.std():8.2f} {np.abs(mdeg).max():8.2f} {trust:12.2f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(
        description="How exact the azimuths of rendered beacons are, and their cost."
    )
    parser.add_argument("width", type=int, nargs="?", default=640)
    parser.add_argument("height", type=int, nargs="?", default=64)
    parser.add_argument("fov_deg", type=float, nargs="?", default=90.0)
    parser.add_argument("frames", type=int, nargs="?", default=400)
    given = parser.parse_args()
    try:
        lens = Lens.of_fov(given.width, given.height, radians(given.fov_deg))
    except ScenarioError as error:
        parser.error(str(error))
    rows, render, detect = measure(lens, max(given.frames, FRAMES_A_SCENE))
    print(f"{lens.width}×{lens.height} over {given.fov_deg:g}°, {len(COLOURS)} beacons in view")
    print("distance  count bias mdeg std mdeg max mdeg error/stated")
    for near in range(int(NEAREST), int(FARTHEST)):
        print(line(f"{near}–{near + 1} m", rows[(rows[:, 0] >= near) & (rows[:, 0] < near + 1)]))
    print(line("all", rows))
    print(f"render {1e3 * render:.2f} ms, detect {1e3 * detect:.2f} ms, detect/render {detect / render:.2f}")


if __name__ == "__main__":
    main()
