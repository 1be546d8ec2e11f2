"""The nouns of the bench: plain values that every part understands and none owns.

Axes are those of REP-103 (x forward, y left, yaw counter-clockwise), units are SI, time is integer
nanoseconds since the start of the run.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import nan
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

if TYPE_CHECKING:  # numpy takes a third of the time of `hilbed check`, which does not need it
    import numpy as np
    import numpy.typing as npt

Nanos: TypeAlias = int
Array: TypeAlias = "npt.NDArray[np.float64]"
Image: TypeAlias = "npt.NDArray[np.uint8]"
Rng: TypeAlias = "np.random.Generator"


class HilbedError(Exception):
    """Anything the bench says to its user instead of showing a traceback."""


class ScenarioError(HilbedError):
    """Something found before the first cycle; `str()` holds every problem, one a line."""


class BusError(HilbedError):
    """Something found on an opened bus: node missing, wrong identity, SDO abort, bus lost."""


class Interrupted(HilbedError):
    """Somebody has asked the run to end."""


class Diverged(HilbedError):
    """The run cannot go on: a number is not finite, the robot fell over or left the world."""


class Pose(NamedTuple):
    """Position (m) and yaw (rad, in (−π, π]) of the midpoint of the (rear) axle in the map."""

    x: float
    y: float
    yaw: float


class Command(NamedTuple):
    """What a robot is asked for: speed v (m/s) and yaw rate w (rad/s) of the axle's midpoint.

    A tricycle takes the speed of what is driven and, in place of w, the angle (rad) of its steering axis.
    """

    v: float
    w: float


class Frame(NamedTuple):
    """One CAN frame."""

    id: int
    data: bytes = b""
    extended: bool = False
    remote: bool = False


class Received(NamedTuple):
    """A frame with the moment at which its last bit had been received."""

    t: Nanos
    frame: Frame


NO_ERROR, BIT_ERROR, ACK_ERROR = range(3)
"""What ended an attempt to send: nothing; a bit that came out inverted, or the frame of another node with
the same identifier; nobody who acknowledged."""


class Transfer(NamedTuple):
    """A frame's whole way over the wire: queued, first bit on the bus, last bit received; who sent it.

    error: not NO_ERROR where the frame was cut off by an error frame, whose last bit `end` then is; nobody
    has received it, and its node will try again. Nodes that sent the same at once are "one+other".
    """

    queued: Nanos
    start: Nanos
    end: Nanos
    frame: Frame
    node: str
    error: int = NO_ERROR


class DriveSignals(NamedTuple):
    """One drive as the controller sees it: what it asked for and what came back over the bus.

    speed_ref, speed_measured: rad/s at the wheel; current_measured: A; NaN until the first PDO. angle_ref,
    angle_measured: rad, of a steering axis, whose speed_ref is its drive's own affair.
    """

    speed_ref: float
    speed_measured: float
    current_measured: float
    angle_ref: float = nan
    angle_measured: float = nan


class Odometry(NamedTuple):
    """What the encoders say since the previous reading.

    t: when the counts were sampled (not when they arrived); distance (m) along the arc and turn (rad)
    since the previous reading's t (both zero while nothing new has arrived); v (m/s) and w (rad/s) at t;
    drives: by name, empty where the robot has none.
    """

    t: Nanos
    distance: float
    turn: float
    v: float
    w: float
    drives: Mapping[str, DriveSignals] = {}


class Reading(NamedTuple):
    """One measurement of the surroundings, without any truth in it.

    kind: "azimuth" (rad, robot's frame, from the sensor's optical centre), "range" (m), "position" (m, m),
    "pose" (m, m, rad), "front" (m, m: of a marker ahead of the axle);
    t: exposure; delivered: when the controller gets it; value and std: one number a component;
    beacon: index in the scenario's list of beacons, None where the identity is unknown.
    """

    kind: str
    t: Nanos
    delivered: Nanos
    value: tuple[float, ...]
    std: tuple[float, ...]
    beacon: int | None = None


class Snapshot(NamedTuple):
    """One exposed frame for the record: image (H, W, 3) uint8 RGB, pan (rad, robot's frame).

    pixels: column of each detection; beacons: its identity, None where unknown.
    """

    t: Nanos
    image: Image
    pan: float
    pixels: tuple[float, ...]
    beacons: tuple[int | None, ...]


class Innovation(NamedTuple):
    """One comparison of a reading with its prediction: NIS over `dof` degrees of freedom."""

    t: Nanos
    nis: float
    dof: int
    accepted: bool


class Estimate(NamedTuple):
    """What an estimator believes at its t: mean (3,) x, y, yaw; covariance (3, 3), NaN where it states none.

    innovations: those of the step that made it; cloud: (M, 3) particles where the estimator has them;
    landmark_distance: m, where one is estimated and known by now, else NaN; front: of a marker ahead of the
    axle (m, m), where it is measured.
    """

    t: Nanos
    mean: Array
    covariance: Array
    innovations: tuple[Innovation, ...] = ()
    cloud: Array | None = None
    landmark_distance: float = nan
    front: tuple[float, float] | None = None


class ReferencePoint(NamedTuple):
    """Where the robot should be, and the speeds that keep it there."""

    pose: Pose
    v: float
    w: float


class Truth(NamedTuple):
    """What the plant knows: for the recorder, the judge and ideal sensors only."""

    t: Nanos
    pose: Pose


class Cycle(NamedTuple):
    """One control period, as the recorder gets it."""

    t: Nanos
    truth: Truth
    odometry: Odometry
    readings: list[Reading]
    estimate: Estimate
    command: Command
