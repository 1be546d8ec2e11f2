"""Scenario block `vision`: at which frames a detector is judged, and by what limits."""

from __future__ import annotations

from typing import Annotated, Literal, NamedTuple, Self

from pydantic import Field, field_validator, model_validator

from hilbed.problems import nearest
from hilbed.spec import Finite, Fraction, Listed, Positive, Spec


class Measure(NamedTuple):
    """A number that a detector is judged by: its unit and what it says."""

    unit: str
    about: str


MEASURES: dict[str, Measure] = {
    "frames": Measure("", "frames that were shown to the detector"),
    "failed_frames": Measure("", "frames for which the detector gave no answer"),
    "beacons": Measure("", "beacons that had to be found"),
    "detections": Measure("", "what the detector found"),
    "recall": Measure("", "part of the beacons that had to be found and was"),
    "precision": Measure("", "part of the detections that show a beacon, with no wrong identity"),
    "false_per_frame": Measure("", "detections that show no beacon, in each frame"),
    "wrong_identities": Measure("", "detections of one beacon that were taken for another"),
    "azimuth_bias_mdeg": Measure("mdeg", "mean error of the azimuths found, at the distance judged"),
    "azimuth_std_mdeg": Measure("mdeg", "standard deviation of the azimuth's error"),
    "azimuth_rms_mdeg": Measure("mdeg", "root mean square of the azimuth's error"),
    "azimuth_max_mdeg": Measure("mdeg", "largest error of an azimuth"),
    "azimuth_bias_px": Measure("px", "mean error of the azimuth in pixels, at its beacon"),
    "azimuth_std_px": Measure("px", "its standard deviation in pixels"),
    "normalised_rms": Measure("", "error over stated standard deviation, rms: 1 where well stated"),
    "time_p50_ms": Measure("ms", "time a frame takes, median"),
    "time_p95_ms": Measure("ms", "time a frame takes, 95 of 100 are quicker"),
    "time_p99_ms": Measure("ms", "time a frame takes, 99 of 100 are quicker"),
}


class LimitSpec(Spec):
    """A limit on a measure, in its unit; both make a range."""

    max: Finite | None = None
    min: Finite | None = None

    @model_validator(mode="after")
    def _limits(self) -> Self:
        if self.max is None and self.min is None:
            raise ValueError("needs max or min, or both")
        if self.max is not None and self.min is not None and self.min > self.max:
            raise ValueError(f"nothing lies from {self.min:g} to {self.max:g}")
        return self


class VisionSpec(Spec):
    """How `hilbed frames` and `hilbed vision` use the camera of a scenario.

    camera: name of the sensor, None for the only one; poses: along the reference, spread over the duration,
    or random ones from the seed, that see a beacon from `distance` (m, from and to); frames: how many;
    visible: a beacon has to be found if at least this part of it is seen, at this distance, and neither
    side is cut off by the border of the image or a nearer beacon; azimuths are judged at this distance, too;
    criteria: limits by the name of a measure.
    """

    camera: str | None = None
    poses: Literal["path", "random"] | None = None
    frames: Annotated[int, Field(ge=1, le=1_000_000)] = 200
    distance: Listed[tuple[Positive, Positive]] = (1.0, 8.0)
    visible: Fraction = 0.25
    criteria: dict[str, LimitSpec] = {}

    @field_validator("distance")
    @classmethod
    def _increases(cls, value: tuple[float, float]) -> tuple[float, float]:
        if not value[0] < value[1]:
            raise ValueError(f"distances must increase, not {value[0]:g}, {value[1]:g}")
        return value

    @field_validator("criteria")
    @classmethod
    def _known(cls, value: dict[str, LimitSpec]) -> dict[str, LimitSpec]:
        for name in value:
            if name not in MEASURES:
                raise ValueError(f"there is no measure {name!r}{nearest(name, list(MEASURES))}")
        return value
