"""A camera on a pan axis: rendered frames become azimuths of beacons, late and not always right."""

from __future__ import annotations

from collections.abc import Sequence
from math import nan, pi, radians
from typing import Annotated, Literal, NamedTuple, Self

import numpy as np
from pydantic import Field, model_validator

from hilbed.angles import wrap
from hilbed.cost import Cost, perf_counter
from hilbed.effects import Effects
from hilbed.ports import Witness
from hilbed.scene import BeaconSpec
from hilbed.sensors.delivery import Delivery, DeliverySpec
from hilbed.sensors.eye import Eye, Glimpse
from hilbed.sensors.faults import misses, noisy, spurious
from hilbed.sensors.pan import make_pan
from hilbed.sensors.pan_spec import FixedSpec, PanSpec
from hilbed.spec import Finite, Fraction, NonNegative, Positive
from hilbed.types import Nanos, Reading, Snapshot, Truth
from hilbed.vision.egl import LARGEST_FRAME
from hilbed.vision.lens import LARGEST, SMALLEST, Lens
from hilbed.vision.seams import Detection, Image
from hilbed.vision.truth import SPURIOUS, match

Size = Annotated[int, Field(ge=SMALLEST, le=LARGEST)]


class CameraSpec(DeliverySpec):
    """A camera that measures azimuths of beacons in rendered frames.

    renderer: tiny (processor) or egl (at most 1024×768); ground: draw it, for pictures, at three times the
    cost; width, height: pixels, 16 to 4096; fov_deg: horizontal field of view, degrees, inside (0, 180);
    mount: m, the optical centre on the pan axis in the robot's frame; identity: colour or anonymous; noise:
    rad, standard deviation added to each azimuth; missed: probability for each detection; spurious: mean
    number of false azimuths a frame.
    """

    kind: Literal["camera"] = "camera"
    renderer: Literal["tiny", "egl"] = "tiny"
    ground: bool = False
    width: Size = 640
    height: Size = 64
    fov_deg: Annotated[float, Field(gt=0, lt=180)] = 90.0
    mount: tuple[Finite, Finite, Positive] = (0.0, 0.0, 0.3)
    pan: PanSpec = FixedSpec()
    identity: Literal["colour", "anonymous"] = "colour"
    noise: Annotated[NonNegative, Field(le=pi)] = 0.0
    missed: Fraction = 0.0
    spurious: Annotated[NonNegative, Field(le=1000)] = 0.0

    @model_validator(mode="after")
    def _egl_can(self) -> Self:
        width, height = LARGEST_FRAME
        if self.renderer == "egl" and (self.width > width or self.height > height):
            raise ValueError(f"renderer egl draws at most {width}×{height} pixels; tiny draws any size")
        return self

    @property
    def lens(self) -> Lens:
        return Lens(self.width, self.height, radians(self.fov_deg))


class Finding(NamedTuple):
    """A detection, the beacon it truly shows and that one's azimuth (rad, robot's frame); −1, NaN: none."""

    detection: Detection
    beacon: int
    azimuth: float


class Camera:
    """A sensor of azimuths: exposes at its rate, delivers after its latency, tells the witness the truth.

    Its time without rendering goes to cost.vision. Raises ScenarioError where the pan axis is to follow a
    beacon that the camera cannot recognise.
    """

    def __init__(
        self, spec: CameraSpec, eye: Eye, rng: np.random.Generator, effects: Effects, witness: Witness
    ) -> None:
        self._spec, self._eye, self._rng = spec, eye, rng
        self._effects, self._witness, self._cost = effects, witness, eye.cost
        self._lens = spec.lens
        self._names = names(spec, eye.beacons)
        self._pan = make_pan(spec.pan, self._names)
        self._delivery = Delivery(spec, rng)

    @property
    def due(self) -> Nanos:
        """When the next frame is to be exposed."""
        return self._delivery.due

    def sample(self, truth: Truth) -> None:
        """Exposes a frame at truth.t, unless the camera is blind, and sends its azimuths on their way."""
        start, rendered = perf_counter(), self._cost.render
        pan = self._pan.turn(truth.t)
        delivered = self._delivery.expose(truth.t)
        if self._effects.blind:
            self._pan.saw([])
            return
        glimpse = self._eye.look(truth.pose, pan)
        findings = self._findings(glimpse, pan)
        self._pan.saw([finding.detection for finding in findings])
        readings = [azimuth(truth.t, delivered, pan, finding.detection) for finding in findings]
        arrives = self._delivery.put(readings)
        self._cost.vision += perf_counter() - start - (self._cost.render - rendered)
        if arrives:
            for reading, finding in zip(readings, findings, strict=True):
                self._witness.reading(reading, finding.beacon, (finding.azimuth,))
        self._witness.snapshot(snapshot(truth.t, glimpse.image, pan, findings))

    def read(self, t: Nanos) -> list[Reading]:
        """Returns the azimuths delivered up to and including t since the last call, oldest first."""
        return self._delivery.read(t)

    def close(self) -> None:
        """Gives back what the renderer holds."""
        self._eye.close()

    def _findings(self, glimpse: Glimpse, pan: float) -> list[Finding]:
        """Returns what the camera reports, misses, noise and false detections applied, from left to right."""
        spec, rng, truth = self._spec, self._rng, glimpse.truth
        found = []
        missed = misses(len(glimpse.detections), spec.missed, rng)
        for detection, miss in zip(glimpse.detections, missed, strict=True):
            if not miss:
                beacon = match(pan + detection.azimuth, truth)
                true = truth[beacon].azimuth if beacon != SPURIOUS else nan
                found.append(Finding(noisy(detection, spec.noise, rng), beacon, true))
        false = spurious(spec.spurious + self._effects.spurious, self._lens, self._names, rng)
        found += [Finding(detection, SPURIOUS, nan) for detection in false]
        return sorted(found, key=lambda finding: finding.detection.column)


def azimuth(t: Nanos, delivered: Nanos, pan: float, detection: Detection) -> Reading:
    """Returns the reading of a detection made at t with the camera at `pan` (rad, robot's frame)."""
    value = wrap(pan + detection.azimuth)
    return Reading("azimuth", t, delivered, (value,), (detection.std,), detection.beacon)


def snapshot(t: Nanos, image: Image, pan: float, findings: Sequence[Finding]) -> Snapshot:
    """Returns what the record keeps of a frame."""
    detections = [finding.detection for finding in findings]
    return Snapshot(
        t, image, wrap(pan), tuple(d.column for d in detections), tuple(d.beacon for d in detections)
    )


def names(spec: CameraSpec, beacons: Sequence[BeaconSpec]) -> list[int | None]:
    """Returns by which index each beacon is recognised: None if anonymous or of a colour that another has."""
    colours = [beacon.colour for beacon in beacons]
    known = spec.identity == "colour"
    return [k if known and colours.count(colour) == 1 else None for k, colour in enumerate(colours)]


def open_eye(spec: CameraSpec, beacons: Sequence[BeaconSpec], cost: Cost) -> Eye:
    """Returns the eye that a scenario describes; raises ScenarioError where its renderer does not work."""
    from hilbed.vision.detect import ColourDetector
    from hilbed.vision.render import BulletRenderer, Scenery

    lens = spec.lens
    renderer = BulletRenderer(lens, Scenery(beacons, spec.renderer == "egl", spec.ground), cost)
    detector = ColourDetector(lens, beacons, spec.identity == "anonymous")
    return Eye(spec.mount, beacons, renderer, detector, cost)
