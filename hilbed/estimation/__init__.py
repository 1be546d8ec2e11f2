"""Estimators: from odometry and readings to a pose and its covariance."""

from hilbed.estimation.specs import DeadReckoningSpec, EkfSpec, EstimatorSpec

__all__ = ["DeadReckoningSpec", "EkfSpec", "EstimatorSpec"]
