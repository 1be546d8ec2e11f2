"""What may be exchanged between the world and a detection: who makes the image, who finds beacons in it."""

from __future__ import annotations

from collections.abc import Iterator
from math import nan
from typing import Literal, NamedTuple, Protocol, TypeAlias, runtime_checkable

from hilbed.types import HilbedError, Image, Nanos, Pose
from hilbed.vision.lens import Lens


class Shot(NamedTuple):
    """What a detector gets: an image and what is known of the camera that took it.

    image: (H, W, 3) RGB; t: exposure; lens: intrinsics and tilt, that is the direction of every pixel.
    """

    image: Image
    t: Nanos
    lens: Lens


class Detection(NamedTuple):
    """One beacon found in an image.

    azimuth: rad about the pan axis, from where the camera's middle looks, left positive; std: of the
    azimuth, rad; column, row: pixels (row NaN where none is stated); beacon: index in the scenario's list of
    beacons, None where the identity is unknown.
    """

    azimuth: float
    std: float
    column: float
    beacon: int | None = None
    row: float = nan


Failure: TypeAlias = Literal["raised", "invalid", "late", "died", "skipped"]


class Trouble(NamedTuple):
    """Why a detector has no answer for a frame.

    failure: raised an exception; invalid: gave back what is no list of detections; late: missed its deadline;
    died: its process has ended; skipped: was not asked any more. text: where and what; said: what it has
    printed since its last answer.
    """

    failure: Failure
    text: str
    said: str = ""


def quoted(said: str, most: int = 10) -> str:
    """Returns the last lines that somebody printed, indented, to go below a message."""
    return "".join(f"\n  | {line}" for line in said.rstrip().splitlines()[-most:])


class DetectionFailed(HilbedError):
    """A detector has no answer for one frame; the frame is left out and the bench goes on."""

    def __init__(self, trouble: Trouble) -> None:
        super().__init__(trouble.text)
        self.trouble = trouble

    @property
    def failure(self) -> Failure:
        return self.trouble.failure


class Detector(Protocol):
    """Finds beacons in an image and knows nothing else."""

    def detect(self, shot: Shot) -> list[Detection]:
        """Returns what is seen, from left to right; raises DetectionFailed where it has no answer."""
        ...


@runtime_checkable
class Closing(Protocol):
    """A detector, or a camera, that holds something to be given back, such as a process of its own."""

    def close(self) -> None: ...


@runtime_checkable
class Talking(Protocol):
    """A detector that prints; said: what, with the frame that it has answered last."""

    said: str


class Source(Protocol):
    """A camera that nobody renders for: an image folder, a video, a live camera, a recorded run.

    lens: of every frame; name: for messages.
    """

    name: str

    @property
    def lens(self) -> Lens: ...

    def frames(self) -> Iterator[Shot]:
        """Yields what it has, in order of time; raises HilbedError for a frame that cannot be used."""
        ...

    def close(self) -> None: ...


class Viewpoint(NamedTuple):
    """Where a camera is and looks: optical centre (m, map); yaw, pitch (down positive), roll (rad)."""

    x: float
    y: float
    z: float
    yaw: float
    pitch: float = 0.0
    roll: float = 0.0


class Renderer(Protocol):
    """Makes the image that a camera sees."""

    def render(self, view: Viewpoint, t: Nanos) -> Image:
        """Returns (H, W, 3) RGB as seen from `view` at t (what flashes or moves does so by t)."""
        ...

    def labels(self, view: Viewpoint, t: Nanos) -> Image:
        """Returns (H, W) of what each pixel shows: 0 nothing of interest, k + 1 the beacon of index k."""
        ...

    def close(self) -> None: ...


class BeaconTruth(NamedTuple):
    """Where one beacon truly is in a frame.

    beacon: index; azimuth, elevation: rad in the camera's frame (its axis at 0; as Detection.azimuth, tilt
    taken out); body_azimuth, body_elevation: in the robot's frame, from the optical centre; distance: m to
    its axis; visible: part (0…1) of its outline that the frame shows, 0 where it is outside or hidden; box:
    pixels (left, top, right, bottom) of what is visible, None where nothing is; column, row: pixels of the
    middle of its axis.
    """

    beacon: int
    azimuth: float
    elevation: float
    body_azimuth: float
    body_elevation: float
    distance: float
    visible: float
    box: tuple[int, int, int, int] | None
    column: float
    row: float


class ShotTruth(NamedTuple):
    """The truth of a frame: exposure time, the camera's viewpoint, the robot's pose and every beacon."""

    t: Nanos
    view: Viewpoint
    body: Pose
    beacons: tuple[BeaconTruth, ...]
