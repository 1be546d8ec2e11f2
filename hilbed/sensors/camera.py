"""A camera on a pan axis: rendered frames become azimuths of beacons, late and not always right."""

from __future__ import annotations

from collections.abc import Sequence
from math import nan, pi
from typing import Annotated, Literal, NamedTuple, Self

from pydantic import Field, model_validator

from hilbed.angles import wrap
from hilbed.clock import nanos
from hilbed.cost import Cost, perf_counter
from hilbed.effects import Effects
from hilbed.ports import Witness
from hilbed.scene import BeaconSpec
from hilbed.sensors.delivery import Delivery, DeliverySpec
from hilbed.sensors.exposure import Exposure, Moment
from hilbed.sensors.eye import Eye, Finding, Glimpse, LocalEye, Setting, Ticket
from hilbed.sensors.faults import misses, noisy, spurious
from hilbed.sensors.imaging import ImagingSpec
from hilbed.sensors.pan import make_pan
from hilbed.sensors.pan_spec import FixedSpec, PanSpec
from hilbed.sensors.troubles import Troubles
from hilbed.spec import Finite, Fraction, Listed, NonNegative, Positive
from hilbed.types import Image, Nanos, Reading, Rng, Snapshot, Truth
from hilbed.vision.detectors import ColourSpec, DetectorSpec, identified, make_detector, patience
from hilbed.vision.egl import LARGEST_FRAME
from hilbed.vision.seams import Detection
from hilbed.vision.truth import SPURIOUS


class CameraSpec(ImagingSpec, DeliverySpec):
    """A camera that measures azimuths of beacons in rendered frames.

    renderer: tiny (processor) or egl (at most 1024×768); ground: a grey floor where the scenery has none;
    mount: m, the optical centre on the pan axis in the robot's frame; detector: a kind, or somebody's
    code; identity: colour or anonymous; noise: rad, standard deviation added to each azimuth; missed:
    probability for each detection; spurious: mean number of false azimuths a frame. What it takes to expose
    and to read out a frame is within latency and the time between frames.
    """

    kind: Literal["camera"] = "camera"
    renderer: Literal["tiny", "egl"] = "tiny"
    ground: bool = False
    mount: Listed[tuple[Finite, Finite, Positive]] = (0.0, 0.0, 0.3)
    pan: PanSpec = FixedSpec()
    detector: DetectorSpec = ColourSpec()
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

    @model_validator(mode="after")
    def _in_time(self) -> Self:
        span = self.exposure + self.readout
        if span > 1.0 / self.rate:
            raise ValueError(f"exposure and readout take {span:g} s, but a frame only {1 / self.rate:g} s")
        if span / 2.0 > self.latency:
            raise ValueError(
                f"latency {self.latency:g} s counts from the middle of the exposure, which ends "
                f"{span / 2:g} s later"
            )
        return self

    def kinds(self) -> dict[str, int]:
        """Returns what it measures, with the number of components."""
        return {"azimuth": 1}


class Opened(NamedTuple):
    """A frame that is being exposed, its middle at t.

    pan: then, rad, robot's frame; blind: it will show nothing; false: mean number of false detections.
    """

    t: Nanos
    delivered: Nanos
    pan: float
    blind: bool
    false: float


class UnderWay(NamedTuple):
    """A frame that has been exposed, and how to get it."""

    frame: Opened
    ticket: Ticket


class Camera:
    """A sensor of azimuths: exposes at its rate, delivers after its latency, tells the witness the truth.

    A frame is rendered and judged when it is exposed, but its result is only asked for when it is delivered,
    or when the next one is exposed: an eye in another process has that long. Time without rendering goes to
    cost.vision. Raises ScenarioError where the pan axis is to follow a beacon that the camera cannot
    recognise.
    """

    def __init__(self, spec: CameraSpec, eye: Eye, rng: Rng, effects: Effects, witness: Witness) -> None:
        self._spec, self._eye, self._rng = spec, eye, rng
        self._effects, self._witness, self._cost = effects, witness, eye.cost
        self._lens = spec.lens
        self._names = names(spec, eye.beacons)
        self._pan = make_pan(spec.pan, self._names)
        self._delivery = Delivery(spec, rng)
        self._half = nanos((spec.exposure + spec.readout) / 2.0)
        self._moments: list[Moment] = []
        self._opened: Opened | None = None
        self._under_way: UnderWay | None = None
        self.troubles = Troubles(spec.detector)

    @property
    def due(self) -> Nanos:
        """When it is to be told where the robot is: as an exposure begins, in its middle, as it ends."""
        if self._opened is not None:
            return self._opened.t + self._half
        return self._delivery.due if self._moments else max(0, self._delivery.due - self._half)

    def sample(self, truth: Truth) -> None:
        """Takes down where the robot is and exposes a frame, unless blind, once that is known to its end."""
        if not self._moments:
            self.flush()
        self._moments.append(Moment(truth.t, truth.pose, self._pan.turn(truth.t)))
        if self._opened is None and truth.t >= self._delivery.due:
            self._opened = self._open(truth.t)
        if self._opened is not None and truth.t >= self._opened.t + self._half:
            self._expose(self._opened)

    def _open(self, t: Nanos) -> Opened:
        blind, false = self._effects.blind, self._spec.spurious + self._effects.spurious
        return Opened(t, self._delivery.expose(t), self._moments[-1].pan, blind, false)

    def _expose(self, frame: Opened) -> None:
        """Sends the azimuths of a frame on their way."""
        exposure = Exposure(frame.t, tuple(self._moments))
        self._opened = None
        self._moments.clear()
        if frame.blind:
            self._pan.saw([])
        else:
            self._under_way = UnderWay(frame, self._eye.look(exposure))

    def read(self, t: Nanos) -> list[Reading]:
        """Returns the azimuths delivered up to and including t since the last call, oldest first."""
        if self._under_way is not None and self._under_way.frame.delivered <= t:
            self.flush()
        return self._delivery.read(t)

    def flush(self) -> None:
        """Takes the frame that is under way, if any, from the eye, and tells the witness; once at the end."""
        if self._under_way is not None:
            frame, ticket = self._under_way
            glimpse = ticket()
            self._under_way = None
            self._develop(frame, glimpse)

    def counts(self) -> dict[str, float]:
        """Returns what a foreign detector did with its frames; nothing of a built-in one."""
        return self.troubles.counts() if self.troubles.foreign else {}

    def close(self) -> None:
        """Gives back what the eye holds; a frame under way is lost."""
        self._under_way = None
        self._eye.close()

    def _develop(self, frame: Opened, glimpse: Glimpse) -> None:
        """Sends a frame's azimuths on their way, with all that goes wrong with them."""
        start = perf_counter()
        t, delivered, pan, _, false = frame
        self.troubles.note(t, glimpse.trouble)
        self.troubles.hear(t, glimpse.said)
        findings = self._faulty(glimpse.findings, false)
        self._pan.saw([finding.detection for finding in findings])
        readings = [azimuth(t, delivered, pan, finding.detection) for finding in findings]
        if self._delivery.put(readings):
            for reading, finding in zip(readings, findings, strict=True):
                self._witness.reading(reading, finding.beacon, (finding.azimuth,))
        self._witness.snapshot(snapshot(t, glimpse.image, pan, findings))
        self._cost.vision += perf_counter() - start

    def _faulty(self, findings: Sequence[Finding], false: float) -> list[Finding]:
        """Returns what the camera reports, misses, noise and false detections applied, from left to right."""
        spec, rng = self._spec, self._rng
        missed = misses(len(findings), spec.missed, rng)
        found = [finding for finding, miss in zip(findings, missed, strict=True) if not miss]
        if spec.noise:
            found = [f._replace(detection=noisy(f.detection, spec.noise, rng)) for f in found]
        if false:
            made_up = spurious(false, self._lens, self._names, rng)
            found += [Finding(detection, SPURIOUS, nan) for detection in made_up]
            found.sort(key=lambda finding: finding.detection.column)
        return found


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
    """Returns by which index each beacon is recognised: None if anonymous, or not to be told from another."""
    known = identified(spec.detector, beacons)
    return [None] * len(known) if spec.identity == "anonymous" else known


def open_eye(spec: CameraSpec, setting: Setting, cost: Cost, separate: bool = False) -> Eye:
    """Returns the eye that a scenario describes, in a process of its own if `separate`.

    Both see the same to the bit. Raises ScenarioError where the renderer does not work.
    """
    if separate:
        from hilbed.sensors.remote import PATIENCE, RemoteEye

        return RemoteEye(spec, setting, cost, PATIENCE + patience(spec.detector))
    from hilbed.sensors.imager import open_imager

    imager = open_imager(spec, setting, cost)
    anonymous = spec.identity == "anonymous"
    detector = make_detector(spec.detector, imager.lens, setting.beacons, anonymous)
    return LocalEye(imager, setting.beacons, detector, cost)
