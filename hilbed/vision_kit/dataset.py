"""Writes a dataset: frame by frame, so that one which was broken off goes on where it stopped.

Frames do not depend on each other, an image is there whole or not at all, and its line of truth follows it.
So what is found counts as far as there are whole lines, and the rest is made as if nothing had happened.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

import cv2

from hilbed import yaml12
from hilbed.record.disk import RecordError
from hilbed.record.folder import check_folder, write_whole
from hilbed.scenario.load import Loaded, resolved
from hilbed.scenario.own_files import pack
from hilbed.types import Image, ScenarioError
from hilbed.versions import versions
from hilbed.vision.seams import ShotTruth
from hilbed.vision_kit.calibration import calibration
from hilbed.vision_kit.coco import coco
from hilbed.vision_kit.labelled import LabelledShot
from hilbed.vision_kit.studio import Studio, Subject
from hilbed.vision_kit.truth_lines import from_line, to_line

DATASET, SCENARIO, TRUTH, COCO = "dataset.yaml", "scenario.yaml", "truth.jsonl", "coco.json"
CALIBRATION, FRAMES, FILES = "calibration.yaml", "frames", "files"
CONTENT = (DATASET, SCENARIO, TRUTH, COCO, CALIBRATION, FRAMES, FILES)


class Plan(NamedTuple):
    """A dataset to be written: whose frames, how many, and the files that say so."""

    subject: Subject
    total: int
    heads: Mapping[str, bytes]


def plan(loaded: Loaded) -> Plan:
    """Returns what a scenario asks for; raises ScenarioError where it has no camera."""
    subject = Subject(loaded)
    packed = pack(loaded.scenario, loaded.folder)
    about = {
        "scenario": loaded.name,
        "seed": loaded.scenario.seed,
        "camera": subject.camera_name,
        "frames": subject.vision.frames,
        "versions": versions(),
    }
    heads = {
        DATASET: yaml12.write(about).encode(),
        SCENARIO: yaml12.write(resolved(packed.scenario, versions())).encode(),
        CALIBRATION: calibration(subject.lens).encode(),
        **packed.contents,
    }
    return Plan(subject, subject.vision.frames, heads)


def write_dataset(plan: Plan, folder: Path, force: bool, tell: Callable[[int], None]) -> int:
    """Writes what is missing of a dataset and returns how many frames were there already.

    tell: is called with the number of each frame that is written. Raises ScenarioError where the folder
    holds anything else, RecordError where it cannot be written.
    """
    _admit(plan, folder, force)
    with Studio(plan.subject) as studio:
        try:
            there = _start(plan, folder)
            with (folder / TRUTH).open("a", encoding="utf-8") as lines:
                for k, taken in enumerate(studio.shots(plan.total, there), there):
                    lines.write(_keep(folder, k, taken))
                    lines.flush()
                    tell(k)
            _write_coco(plan, folder)
        except OSError as error:
            raise RecordError(f"{error.filename or folder}: {error.strerror}") from error
    return there


def _write_coco(plan: Plan, folder: Path) -> None:
    """Writes the boxes of all frames; the file takes its place when it is whole."""
    temporary = folder / f".{COCO}.tmp"
    with temporary.open("w", encoding="utf-8") as file:
        file.writelines(coco(lambda: read_truth(folder), plan.subject.beacons, plan.subject.lens))
    temporary.replace(folder / COCO)


def read_truth(folder: Path) -> Iterator[tuple[str, ShotTruth]]:
    """Yields image file and truth of each frame of a dataset; raises ScenarioError naming a broken line."""
    path = folder / TRUTH
    with path.open(encoding="utf-8", errors="replace") as lines:
        for number, line in enumerate(lines, 1):
            try:
                yield from_line(line)
            except ValueError as error:
                raise ScenarioError(f"{path}:{number}: {error}") from None


def _admit(plan: Plan, folder: Path, force: bool) -> None:
    """Lets an empty folder pass, and one that was begun with the same plan; others only if forced.

    With force the old dataset goes; what is not a dataset is never removed.
    """
    if not check_folder(folder):
        return
    try:
        if not (folder / DATASET).is_file():
            raise ScenarioError(f"{folder} holds no dataset, so nothing is written there; give another --out")
        if force:
            for name in CONTENT:
                _remove(folder / name)
        elif any(_content(folder / name) != data for name, data in plan.heads.items()):
            raise ScenarioError(
                f"{folder} holds another dataset, or one of other versions; --force replaces it, --out takes "
                "another folder"
            )
    except OSError as error:
        raise ScenarioError(f"{folder}: {error.strerror}; give another folder with --out") from error


def _content(path: Path) -> bytes | None:
    with suppress(FileNotFoundError):
        return path.read_bytes()
    return None


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def _start(plan: Plan, folder: Path) -> int:
    """Writes what the frames do not change, dataset.yaml last, and returns how many frames are whole."""
    (folder / FRAMES).mkdir(parents=True, exist_ok=True)
    for name in reversed(list(plan.heads)):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        write_whole(folder / name, plan.heads[name])
    lines = _whole_lines(folder, plan.total)
    write_whole(folder / TRUTH, "".join(lines).encode())
    return len(lines)


def _whole_lines(folder: Path, most: int) -> list[str]:
    """Returns the lines of truth up to the first one that is broken or lacks its image."""
    found: list[str] = []
    for line in (_content(folder / TRUTH) or b"").decode(errors="replace").splitlines(keepends=True)[:most]:
        with suppress(ValueError):
            file, _ = from_line(line)
            if line.endswith("\n") and file == name_of(len(found)) and (folder / file).is_file():
                found.append(line)
                continue
        break
    return found


def name_of(k: int) -> str:
    """Returns where in a dataset the image of frame k lies."""
    return f"{FRAMES}/{k:06d}.png"


def _keep(folder: Path, k: int, taken: LabelledShot) -> str:
    """Writes a frame's image and returns its line of truth."""
    write_whole(folder / name_of(k), png(taken.shot.image))
    return to_line(k, name_of(k), taken.truth)


def png(image: Image) -> bytes:
    """Returns an (H, W, 3) RGB image as PNG."""
    done, data = cv2.imencode(".png", image[:, :, ::-1])
    assert done, "any image of three channels can be a PNG"
    return data.tobytes()
