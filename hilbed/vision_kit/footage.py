"""What `hilbed vision` shows to whom: frames of a scenario or a dataset, and the detector of their camera."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from hilbed.scenario.load import load
from hilbed.sweep import listed
from hilbed.types import ScenarioError
from hilbed.vision.detectors import make_detector
from hilbed.vision.seams import Closing, Detector
from hilbed.vision_kit.archive import Archive, is_dataset
from hilbed.vision_kit.labelled import LabelledShot
from hilbed.vision_kit.studio import Studio, Subject


class Footage(NamedTuple):
    """Labelled frames, how many, and whose they are."""

    subject: Subject
    total: int
    shots: Iterator[LabelledShot]


def varied(options: Namespace) -> list[str]:
    """Returns the settings of `--vary`, all of which hold; an empty one without it."""
    if options.vary is None:
        return [""]
    if is_dataset(options.scenario):
        raise ScenarioError(f"--vary renders frames, and {options.scenario} has its own")
    path, values = listed("--vary", options.vary)
    found = [f"{path}={value}" for value in dict.fromkeys(values)]
    for setting in found:
        load(options.scenario, [*options.settings, setting], options.seed, options.detector)
    return found


@contextmanager
def footage(options: Namespace, setting: str) -> Iterator[Footage]:
    """Yields the frames of a dataset, or those rendered of a scenario, with one more setting if there is."""
    settings = [*options.settings, *([setting] if setting else [])]
    if options.count is not None and options.count < 1:
        raise ScenarioError(f"-n {options.count}: at least one frame is needed")
    if is_dataset(options.scenario):
        archive = Archive(Path(options.scenario), settings, options.seed, options.detector)
        total = min(options.count or len(archive), len(archive))
        yield Footage(archive.subject, total, archive.shots(total))
        return
    if options.count is not None:
        settings.append(f"vision.frames={options.count}")
    subject = Subject(load(options.scenario, settings, options.seed, options.detector))
    with Studio(subject) as studio:
        yield Footage(subject, subject.vision.frames, studio.shots(subject.vision.frames))


@contextmanager
def opened_detector(subject: Subject) -> Iterator[Detector]:
    """Yields the detector of a camera, and closes it where it holds anything."""
    camera = subject.camera
    anonymous = camera.identity == "anonymous"
    detector = make_detector(camera.detector, subject.lens, subject.beacons, anonymous)
    try:
        yield detector
    finally:
        if isinstance(detector, Closing):
            detector.close()
