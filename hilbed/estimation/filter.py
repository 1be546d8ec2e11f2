"""filterpy's extended Kalman filter for a pose (x, y, yaw), valid from the start and at any angle."""

from __future__ import annotations

import numpy as np
from filterpy.kalman import ExtendedKalmanFilter

from hilbed.angles import wrap
from hilbed.estimation.measurement import Prediction
from hilbed.estimation.motion import predicted, symmetric
from hilbed.estimation.odometry_model import OdometryModel
from hilbed.types import Array


class PoseFilter(ExtendedKalmanFilter):  # type: ignore[misc]
    """State (3,) x, y (m), yaw (rad); scalar measurements, one after the other, in Joseph's form.

    `predict` and `predict_update` are not for use: the motion is nonlinear, `move` takes their place.
    """

    def __init__(self, mean: Array, covariance: Array) -> None:
        super().__init__(dim_x=3, dim_z=1)
        self.load(mean, covariance)

    def load(self, mean: Array, covariance: Array) -> None:
        """Takes over a state; arrays are never changed in place, so they may be shared."""
        self.x, self.P = mean, covariance

    def move(self, distance: float, turn: float, model: OdometryModel) -> None:
        """Predicts by an odometry increment (m, rad)."""
        self.x, self.P = predicted(self.x, self.P, (distance, turn), model)

    @property
    def positive(self) -> bool:
        """Whether all variances are positive; NaN is not."""
        return bool((self.P.diagonal() > 0.0).all())

    def spread(self, expected: Prediction) -> float:
        """Returns the variance H P Hᵀ of a predicted reading, at least 0 whatever round-off says."""
        g0, g1, g2 = expected.gradient
        (xx, xy, xt), (_, yy, yt), (_, _, tt) = self.P.tolist()
        variance = (
            g0 * g0 * xx + g1 * g1 * yy + g2 * g2 * tt + 2 * (g0 * g1 * xy + g0 * g2 * xt + g1 * g2 * yt)
        )
        return max(float(variance), 0.0)

    def correct(self, innovation: float, variance: float, expected: Prediction) -> None:
        """Updates by one scalar innovation whose noise has `variance`."""
        H = np.array((expected.gradient,))
        self.update(
            np.array((innovation,)),
            HJacobian=lambda _: H,
            Hx=lambda _: 0.0,  # the innovation is already a difference, wrapped where it is an angle
            R=np.array(((variance,),)),
        )
        self.x = _wrapped(self.x)
        self.P = symmetric(self.P)


def _wrapped(state: Array) -> Array:
    state[2] = wrap(float(state[2]))
    return state
