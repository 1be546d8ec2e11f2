"""Prints how exact azimuths are under each degradation, and what degradation and detection cost.

.venv/bin/python scripts/camera_numbers.py [--frames N] [--memory N]

Cost is processor time beside that of the bare renderer, taken in turn, scene by scene, so that a busy machine
changes both alike. --memory exposes N frames more and prints how the resident memory moves meanwhile.
"""

from __future__ import annotations

import argparse
import resource
from math import atan2, cos, hypot, sin
from time import thread_time
from typing import Any, NamedTuple

import numpy as np

from hilbed.cost import Cost
from hilbed.scene import BeaconSpec
from hilbed.sensors.camera import CameraSpec
from hilbed.sensors.exposure import Exposure, Moment
from hilbed.sensors.eye import Setting
from hilbed.sensors.imager import Imager, open_imager
from hilbed.types import Array, Pose
from hilbed.vision.detect import ColourDetector

COLOURS = ("red", "orange", "green", "azure", "magenta", "yellow")
NEAREST, FARTHEST = 1.0, 8.0
A_SCENE = 10
RATE = 0.7  # rad/s that the camera turns at: 0.9 pixels in 4 ms

BLUR: dict[str, Any] = {"exposure": 0.004}
NOISE: dict[str, Any] = {"shot_noise": 0.02, "read_noise": 0.02}
DISTORTION: dict[str, Any] = {"k1": -0.05, "k2": 0.005, "p1": 5e-4}
CASES: dict[str, dict[str, Any]] = {
    "clean": {},
    "2560×32": {"width": 2560, "height": 32},
    "motion blur": BLUR,
    "long blur": {"exposure": 0.02},
    "rolling shutter": {"readout": 0.005},
    "noise": NOISE,
    "strong noise": {"shot_noise": 0.05, "read_noise": 0.05},
    "dark": {"gain": 0.3, "read_noise": 0.02},
    "distortion": DISTORTION,
    "tilt": {"tilt_deg": 10.0, "height": 240},
    "3 bits, gamma": {"bits": 3, "gamma": 2.2, "vignetting": 0.4},
    "blur+noise+dist.": {**BLUR, **NOISE, **DISTORTION},
}


class Result(NamedTuple):
    """Rows of error and stated std (rad); missed and wrong ones; s of processor a frame."""

    rows: Array
    expected: int
    wrong: int
    bare: float
    shoot: float
    detect: float


def scene(fov: float, rng: np.random.Generator) -> tuple[BeaconSpec, ...]:
    """Returns beacons side by side in front of the origin."""
    azimuths = fov * (np.linspace(-0.42, 0.42, len(COLOURS)) + rng.uniform(-0.02, 0.02, len(COLOURS)))
    distances = rng.uniform(NEAREST, FARTHEST, len(COLOURS))
    places = zip(azimuths.tolist(), distances.tolist(), COLOURS, strict=True)
    return tuple(
        BeaconSpec.model_validate({"at": (d * cos(a), d * sin(a)), "colour": colour})
        for a, d, colour in places
    )


def turning(pose: Pose, t: int, rate: float) -> Exposure:
    """Returns an exposure in which the robot turns at `rate` (rad/s)."""
    half = 25_000_000
    moments = [(k * half, pose._replace(yaw=pose.yaw + rate * 1e-9 * k * half)) for k in (-1, 0, 1)]
    return Exposure(t, tuple(Moment(t + late, one, 0.0) for late, one in moments))


def measure(block: dict[str, Any], frames: int) -> Result:
    """Returns what a camera of these keys makes of scenes of A_SCENE frames each."""
    spec, rng, rows, wrong, took = (
        CameraSpec.model_validate(block),
        np.random.default_rng(1),
        [],
        0,
        np.zeros(3),
    )
    size: dict[str, Any] = {name: block[name] for name in ("width", "height") if name in block}
    scenes = frames // A_SCENE
    for number in range(scenes):
        beacons = scene(spec.lens.fov, rng)
        bare, camera = (open_imager(CameraSpec(**one), Setting(beacons), Cost()) for one in (size, block))
        detector = ColourDetector(spec.lens, beacons)
        poses = [Pose(*rng.uniform(-0.05, 0.05, 3).tolist()) for _ in range(A_SCENE)]
        times = [10**8 * (1 + A_SCENE * number + k) for k in range(A_SCENE)]
        exposures = [
            turning(p, t, RATE * (-1) ** k) for k, (p, t) in enumerate(zip(poses, times, strict=True))
        ]
        times_taken = [thread_time()]
        for exposure in exposures:
            bare.shoot(exposure)
        times_taken.append(thread_time())
        shots = [camera.shoot(exposure) for exposure in exposures]
        times_taken.append(thread_time())
        found = [detector.detect(shot) for shot in shots]
        times_taken.append(thread_time())
        took += np.diff(times_taken)
        for pose, detections in zip(poses, found, strict=True):
            for one in detections:
                assert one.beacon is not None
                bx, by = beacons[one.beacon].at
                error = one.azimuth + pose.yaw - atan2(by - pose.y, bx - pose.x)
                wrong += abs(error) > np.arctan(0.07 / hypot(bx - pose.x, by - pose.y))
                rows.append((error, one.std))
        bare.close()
        camera.close()
    count = scenes * A_SCENE
    return Result(np.array(rows), len(COLOURS) * count, wrong, *(took / count))


def line(name: str, result: Result) -> str:
    mdeg = 1e3 * np.degrees(result.rows[:, 0])
    trust = np.sqrt(np.mean((result.rows[:, 0] / result.rows[:, 1]) ** 2))
    right = len(mdeg) - result.wrong
    found = f"{1e2 * right / result.expected:7.2f} {1e2 * right / len(mdeg):10.2f}"
    exact = f"{found} {mdeg.mean():7.2f} {mdeg.std():7.2f}"
    bare, added, detect = result.bare, result.shoot - result.bare, result.detect
    cost = f"{1e3 * bare:8.2f} {added / bare:12.2f} {detect / bare:8.2f}"
    return f"{name:17} {exact} {trust:13.2f} {cost}"


def memory() -> float:
    """Returns the largest resident memory so far, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def watch(frames: int) -> None:
    """Exposes and judges frames with everything on, and prints the resident memory ten times."""
    spec = CameraSpec.model_validate({**BLUR, **NOISE, **DISTORTION, "readout": 0.002})
    beacons = scene(spec.lens.fov, np.random.default_rng(1))
    imager: Imager = open_imager(spec, Setting(beacons), Cost())
    detector = ColourDetector(spec.lens, beacons)
    for frame in range(frames):
        detector.detect(imager.shoot(turning(Pose(0.0, 0.0, 1e-5 * frame), 10**8 * (1 + frame), RATE)))
        if frame % max(1, frames // 10) == 0:
            print(f"after {frame + 1:6} frames {memory():.1f} MB", flush=True)
    print(f"after {frames:6} frames {memory():.1f} MB")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--frames", type=int, default=100, help="of each degradation")
    parser.add_argument("--memory", type=int, default=0, metavar="N", help="frames to watch the memory over")
    given = parser.parse_args()
    print(
        f"{len(COLOURS)} beacons from {NEAREST:g} to {FARTHEST:g} m; the camera turns at {RATE:g} rad/s; mdeg"
    )
    print(
        "degradation       recall % precision %  bias     std error/stated  bare ms degrade/bare detect/bare"
    )
    for name, block in CASES.items():
        print(line(name, measure(block, max(given.frames, A_SCENE))), flush=True)
    if given.memory > 0:
        watch(given.memory)


if __name__ == "__main__":
    main()
