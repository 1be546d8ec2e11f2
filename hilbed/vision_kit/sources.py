"""Frames that have no truth, as a command line names them, and what is known of their camera."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from math import radians
from pathlib import Path
from typing import NamedTuple

from pydantic import TypeAdapter, ValidationError

from hilbed.build.known import boot_of
from hilbed.record.folder import MCAP, SCENARIO, VERDICT
from hilbed.scenario.detectors import given
from hilbed.scenario.load import load
from hilbed.scene import BeaconSpec
from hilbed.types import ScenarioError
from hilbed.vision.calibration import Optics, read_lens
from hilbed.vision.detectors import AnyDetector, DetectorSpec
from hilbed.vision.image_folder import ImageFolder
from hilbed.vision.live import LiveCamera
from hilbed.vision.log_frames import LogFrames
from hilbed.vision.seams import Source
from hilbed.vision.video import VideoFile
from hilbed.vision_kit.dataset import CALIBRATION, DATASET, TRUTH
from hilbed.vision_kit.studio import Subject

VIDEOS = (".avi", ".mp4", ".mkv", ".mov", ".webm", ".mjpg", ".mjpeg", ".ts", ".m4v", ".mpg", ".mpeg")
FOV = 90.0
"""degrees, of a camera of which nothing is known."""


def is_feed(name: str) -> bool:
    """Tells whether a name means frames without truth: device, URL, video, log, folder of images or run."""
    path = Path(name)
    if path.is_dir():
        return not ((path / DATASET).exists() or (path / TRUTH).exists())
    return name.isdecimal() or "://" in name or path.suffix.lower() in (*VIDEOS, ".mcap")


class Task(NamedTuple):
    """What is to be looked for, and by whom; beacons: None where it is not known what there is."""

    detector: AnyDetector
    beacons: Sequence[BeaconSpec] | None
    anonymous: bool = False


def check(options: Namespace) -> None:
    """Raises ScenarioError for an option that is out of range."""
    limits = (("fov_deg", 180.0), ("rate", 1e6), ("timeout", 3600.0))
    for name, most in limits:
        value = getattr(options, name)
        if value is not None and not 0.0 < value < most:
            option = name.replace("_", "-")
            raise ScenarioError(f"--{option} {value:g}: must lie between 0 and {most:g}")
    if options.count is not None and options.count < 1:
        raise ScenarioError(f"-n {options.count}: at least one frame")


def subject_of(options: Namespace) -> Subject | None:
    """Returns whose camera it is: that of the run, or of the scenario that is named with `--like`."""
    folder = _run_folder(options.scenario)
    like = options.like or (None if folder is None else str(folder / SCENARIO))
    if like is None:
        if options.settings:
            raise ScenarioError("--set needs a scenario: name one with --like")
        return None
    return Subject(load(like, options.settings, options.seed, options.detector))


def _run_folder(name: str) -> Path | None:
    path = Path(name)
    if path.suffix == ".mcap" and not path.is_file():
        raise ScenarioError(f"there is no file {path}")
    folder = path.parent if path.suffix == ".mcap" else path
    is_run = path.suffix == ".mcap" or (path / MCAP).exists() or (path / VERDICT).exists()
    return folder if is_run else None


def task_of(subject: Subject | None, options: Namespace) -> Task:
    """Returns what is to be looked for: what the scenario says, else what `--detector` names."""
    if subject is not None:
        camera = subject.camera
        return Task(camera.detector, subject.beacons, camera.identity == "anonymous")
    if options.detector is None:
        raise ScenarioError(
            f"{options.scenario}: which detector? --detector names one, --like SCENARIO takes a scenario's"
        )
    adapter: TypeAdapter[AnyDetector] = TypeAdapter(DetectorSpec)
    try:
        return Task(adapter.validate_python(given(options.detector, None)), None)
    except ValidationError as error:
        raise ScenarioError(f"--detector {options.detector}: {error.errors()[0]['msg']}") from None


def open_source(options: Namespace, subject: Subject | None) -> Source:
    """Opens the frames that a name means."""
    name, path = options.scenario, Path(options.scenario)
    if subject is not None and _run_folder(name) is not None:
        log = path if path.suffix == ".mcap" else path / MCAP
        return LogFrames(log, subject.lens, boot_of(subject.scenario))
    optics = _optics(options, subject)
    if path.is_dir():
        return ImageFolder(path, optics, options.rate)
    if name.isdecimal() or "://" in name:
        return LiveCamera(int(name) if name.isdecimal() else name, optics, options.timeout)
    return VideoFile(path, optics)


def _optics(options: Namespace, subject: Subject | None) -> Optics:
    """Returns what is known of the camera: a calibration, a field of view, or the scenario's lens."""
    beside = Path(options.scenario) / CALIBRATION
    known = options.calibration or (beside if beside.is_file() else None)
    if known is not None:
        return Optics(read_lens(known), 0.0)
    if options.fov_deg is None and subject is not None:
        return Optics(subject.lens, 0.0)
    if options.fov_deg is None:
        print(
            f"no calibration: azimuths are those of a field of view of {FOV:g}°; --calibration, --fov-deg",
            file=sys.stderr,
        )
    return Optics(None, radians(FOV if options.fov_deg is None else options.fov_deg))
