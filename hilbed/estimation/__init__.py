"""Estimators: from odometry and readings to a pose and its covariance."""

from hilbed.estimation.attitude_spec import AttitudeSpec
from hilbed.estimation.bearing_specs import (
    BearingKalmanSpec,
    LuenbergerSpec,
    LyapunovObserverSpec,
    SurveySpec,
)
from hilbed.estimation.measured_spec import MeasuredSpec
from hilbed.estimation.particle_spec import ParticleFilterSpec
from hilbed.estimation.specs import DeadReckoningSpec, EkfSpec

EstimatorSpec = (
    EkfSpec
    | DeadReckoningSpec
    | LyapunovObserverSpec
    | BearingKalmanSpec
    | LuenbergerSpec
    | SurveySpec
    | ParticleFilterSpec
    | AttitudeSpec
    | MeasuredSpec
)

__all__ = ["DeadReckoningSpec", "EkfSpec", "EstimatorSpec"]
