"""Scenario blocks of the estimators."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from hilbed.estimation.odometry_model import OdometryModel
from hilbed.spec import Finite, Listed, NonNegative, Point, Positive, Spec

Deviation = Annotated[float, Field(ge=1e-9, le=1e6)]
"""A standard deviation; one of zero would leave nothing to divide by."""

SmallAngle = Annotated[float, Field(ge=-3.2, le=3.2, allow_inf_nan=False)]


class OdometrySpec(Spec):
    """Errors of the odometer as the estimator believes them.

    direction: of travel in the robot's frame, rad; scales: true over told; distance_noise m/√m,
    heading_noise rad/√m, turn_noise rad/√rad: standard deviations per root of the way.
    """

    direction: SmallAngle = 0.0
    distance_scale: Positive = 1.0
    turn_scale: Positive = 1.0
    distance_noise: NonNegative = 0.05
    heading_noise: NonNegative = 0.1
    turn_noise: NonNegative = 0.05

    def model(self) -> OdometryModel:
        """Returns the same as a plain value."""
        return OdometryModel(**self.model_dump())


class ReadingSpec(Spec):
    """One kind of reading as the estimator believes it.

    use: whether it is used; std (rad or m): in place of what the reading says of itself; bias (rad or m):
    taken off each reading; beacon_std (m): doubt about each beacon's place, which makes near azimuths
    worse than far ones: variance = std² + (beacon_std · ∂h/∂beacon)².
    """

    use: bool = True
    std: Deviation | None = None
    bias: Finite = 0.0
    beacon_std: NonNegative = 0.0


class InflationSpec(Spec):
    """Doubt grows when the gate keeps refusing: P is taken `factor` times at `after` refusals in a row."""

    after: Annotated[int, Field(ge=1)] = 5
    factor: Annotated[float, Field(gt=1, le=100)] = 4.0


class EkfSpec(Spec):
    """Extended Kalman filter of the pose: odometry, then azimuths and ranges one by one.

    initial_std: x m, y m, yaw rad; gate: e in v²/S ≤ e², null for none; delay (s): by which exposure
    stamps are late, taken off them; mount (m): sensor in the robot's frame, null for the sensor's own;
    memory (s): how old a reading may be.
    """

    kind: Literal["ekf"] = "ekf"
    initial_std: Listed[tuple[Deviation, Deviation, Deviation]] = (0.01, 0.01, 0.01)
    odometry: OdometrySpec = OdometrySpec()
    azimuth: ReadingSpec = ReadingSpec()
    range: ReadingSpec = ReadingSpec()
    gate: Positive | None = 3.0
    inflation: InflationSpec | None = InflationSpec()
    delay: Annotated[float, Field(ge=-1, le=1, allow_inf_nan=False)] = 0.0
    mount: Point | None = None
    memory: Annotated[float, Field(gt=0, le=60)] = 1.0


class DeadReckoningSpec(Spec):
    """Odometry alone, with the doubt that grows on the way; initial_std: x m, y m, yaw rad."""

    kind: Literal["odometry"] = "odometry"
    initial_std: Listed[tuple[Deviation, Deviation, Deviation]] = (0.01, 0.01, 0.01)
    odometry: OdometrySpec = OdometrySpec()
