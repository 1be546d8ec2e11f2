"""Detectors by their kind: those of hilbed, and foreign ones that somebody else has written."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import BeforeValidator, Field

from hilbed.problems import nearest, shorten
from hilbed.scene import COLOURS, BeaconSpec
from hilbed.spec import Positive, Spec
from hilbed.vision.code import Code, parse
from hilbed.vision.lens import Lens
from hilbed.vision.seams import Detector


class ColourSpec(Spec):
    """Finds cones by their colour: the edges of each, to a fraction of a pixel."""

    kind: Literal["colour"] = "colour"


class MarkersSpec(Spec):
    """Finds ArUco or AprilTag markers, of the dictionaries that the beacons name.

    dictionary: where no beacons are known, by its name in OpenCV; std: pixels, of the column of a marker's
    middle, as measured on rendered frames, whose edges are as coarse as pixels; a real camera's are smooth.
    """

    kind: Literal["markers"] = "markers"
    dictionary: Literal[
        "4X4_50", "5X5_50", "6X6_50", "APRILTAG_16h5", "APRILTAG_25h9", "APRILTAG_36h11"
    ] = "4X4_50"  # fmt: skip
    std: Positive = 0.18


def _code(value: Any) -> Any:
    if isinstance(value, str):
        parse(value)
    return value


class ForeignSpec(Spec):
    """Somebody else's detector, in a process of its own.

    code: `package.module:Class` of an installed package, `file.py` or `file.py:Class` in the scenario's
    folder; options: what its class is made with; deadline: s for a frame; startup: s until it is made.
    """

    kind: Literal["foreign"] = "foreign"
    code: Annotated[str, BeforeValidator(_code)]
    deadline: Annotated[Positive, Field(le=60)] = 2.0
    startup: Annotated[Positive, Field(le=600)] = 60.0
    options: dict[str, Any] = {}


KINDS: dict[str, type[Spec]] = {"colour": ColourSpec, "markers": MarkersSpec, "foreign": ForeignSpec}


def _word(value: Any) -> Any:
    """A word, or a kind, that is none of the known ones names code."""
    kind = value.get("kind") if isinstance(value, dict) else value
    if not isinstance(kind, str) or kind in KINDS:
        return {"kind": value} if isinstance(value, str) else value
    if not Code.named_by(kind):
        known = nearest(kind, list(KINDS))
        raise ValueError(f"{shorten(kind)} is neither a kind nor code (package.module:Class, file.py){known}")
    rest = value if isinstance(value, dict) else {}
    return {**rest, "kind": "foreign", "code": kind}


Beacons: TypeAlias = Sequence[BeaconSpec] | None
AnyDetector: TypeAlias = ColourSpec | MarkersSpec | ForeignSpec
DetectorSpec: TypeAlias = Annotated[AnyDetector, Field(discriminator="kind"), BeforeValidator(_word)]
"""`detector: colour`, `detector: file.py:Class` or a block with its kind."""


def patience(spec: AnyDetector) -> float:
    """Returns how long (s) a detector may take for a frame before it is given up."""
    return spec.startup + spec.deadline if isinstance(spec, ForeignSpec) else 0.0


def identified(spec: AnyDetector, beacons: Sequence[BeaconSpec]) -> list[int | None]:
    """Returns by which index a detector knows each beacon: None where it has its mark in common, or none."""
    marks = [_MARKS[spec.kind](k, beacon) for k, beacon in enumerate(beacons)]
    return [k if mark is not None and marks.count(mark) == 1 else None for k, mark in enumerate(marks)]


_MARKS: dict[str, Callable[[int, BeaconSpec], object]] = {
    "colour": lambda _, beacon: beacon.colour,
    "markers": lambda _, beacon: None if beacon.marker is None else (beacon.dictionary, beacon.marker),
    "foreign": lambda k, _: k,
}
"""By what each kind of detector tells beacons apart."""


def make_detector(spec: AnyDetector, lens: Lens, beacons: Beacons, anonymous: bool = False) -> Detector:
    """Returns the detector that a scenario describes.

    beacons: None where it is not known what there is; then a beacon's index is the number of its colour in
    `COLOURS`, or of its marker. anonymous: it does not tell beacons apart. Raises ScenarioError where foreign
    code cannot be used.
    """
    return _MAKERS[spec.kind](spec, lens, beacons, anonymous)


def _colour(_: Any, lens: Lens, beacons: Beacons, anonymous: bool) -> Detector:
    from hilbed.vision.detect import ColourDetector

    if beacons is None:
        beacons = [BeaconSpec.model_validate({"at": (0.0, 0.0), "colour": colour}) for colour in COLOURS]
    return ColourDetector(lens, beacons, anonymous)


def _markers(spec: Any, lens: Lens, beacons: Beacons, anonymous: bool) -> Detector:
    from hilbed.vision.markers import MarkerDetector

    return MarkerDetector(spec, lens, beacons, anonymous)


def _foreign(spec: Any, lens: Lens, beacons: Beacons, anonymous: bool) -> Detector:
    from hilbed.vision.foreign import ForeignDetector

    return ForeignDetector(spec, lens, sys.maxsize if beacons is None else len(beacons), anonymous)


_MAKERS: dict[str, Callable[[Any, Lens, Beacons, bool], Detector]] = {
    "colour": _colour, "markers": _markers, "foreign": _foreign,
}  # fmt: skip
