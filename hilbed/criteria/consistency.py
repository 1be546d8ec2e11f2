"""Whether estimator and sensors are as good as they say."""

from __future__ import annotations

import numpy as np

from hilbed.criteria.pose import rms, turned, wrapped
from hilbed.criteria.signals import Column, Missing, Signals

_MDEG = 1000 * 180 / np.pi


def nees_mean(signals: Signals) -> float:
    """Normalised squared error of the estimated pose, mean; 3 if the covariance is right."""
    return mean(nees(signals, 3))


def nees_position_mean(signals: Signals) -> float:
    """Normalised squared error of the estimated position, mean; 2 if the covariance is right."""
    return mean(nees(signals, 2))


def nis_mean(signals: Signals) -> float:
    """Normalised innovation squared per degree of freedom, mean over those that were accepted."""
    accepted = signals["nis/accepted"].astype(bool)
    return mean(signals["nis/value"][accepted] / signals["nis/dof"][accepted])


def accepted_fraction(signals: Signals) -> float:
    """Part of the innovations that passed the gate."""
    return mean(signals["nis/accepted"].astype(float))


def azimuth_count(signals: Signals) -> float:
    """Number of azimuths of real beacons."""
    return float(len(residuals(signals, "azimuth")))


def azimuth_spurious(signals: Signals) -> float:
    """Number of azimuths that belong to no beacon."""
    return float(np.count_nonzero(signals["azimuth/beacon"] < 0))


def azimuth_bias_mdeg(signals: Signals) -> float:
    """Magnitude of the mean of measured minus true azimuth, without spurious ones."""
    return abs(mean(residuals(signals, "azimuth"))) * _MDEG


def azimuth_std_mdeg(signals: Signals) -> float:
    """Standard deviation of measured minus true azimuth, without spurious ones."""
    return spread(residuals(signals, "azimuth")) * _MDEG


def azimuth_rms_mdeg(signals: Signals) -> float:
    """Measured minus true azimuth, root mean square, without spurious ones."""
    return rms(residuals(signals, "azimuth")) * _MDEG


def range_bias(signals: Signals) -> float:
    """Magnitude of the mean of measured minus true range, without spurious ones."""
    return abs(mean(residuals(signals, "range")))


def range_std(signals: Signals) -> float:
    """Standard deviation of measured minus true range, without spurious ones."""
    return spread(residuals(signals, "range"))


def position_count(signals: Signals) -> float:
    """Number of measured positions, NaN ones included."""
    return float(len(position_errors(signals)))


def position_rms(signals: Signals) -> float:
    """Distance between measured and true position, root mean square."""
    return rms(position_errors(signals))


def nees(signals: Signals, size: int) -> Column:
    """Returns eᵀ P⁻¹ e (N,) over the first `size` components of the pose; NaN where P is singular.

    Bar-Shalom, Li and Kirubarajan, Estimation with Applications to Tracking and Navigation, section 5.4.
    Raises Missing of a particle filter: where the robot stands its cloud shrinks to a point, and its
    covariance is no measure of the error.
    """
    if "cloud/t" in signals:
        raise Missing("the covariance is that of a cloud of particles")
    error = signals["estimate"] - signals["truth"]
    error[:, 2] = turned(signals, "estimate")
    error, covariance = error[:, :size], signals["covariance"][:, :size, :size]
    scale = np.prod(np.diagonal(covariance, axis1=1, axis2=2), axis=1)
    with np.errstate(invalid="ignore"):
        regular = (np.linalg.det(covariance) > 1e-12 * scale) & (scale > 0)
    regular &= np.isfinite(error).all(axis=1)
    values = np.full(len(error), np.nan)
    solved = np.linalg.solve(covariance[regular], error[regular][:, :, None])[:, :, 0]
    values[regular] = np.sum(error[regular] * solved, axis=1)
    return values


def residuals(signals: Signals, kind: str) -> Column:
    """Returns measured minus true (K,) of the readings that belong to a beacon; angles wrapped."""
    real = signals[f"{kind}/beacon"] >= 0
    difference = (signals[f"{kind}/measured"] - signals[f"{kind}/true"])[real]
    return wrapped(difference) if kind == "azimuth" else difference


def position_errors(signals: Signals) -> Column:
    """Returns the distance (K,) in m between measured and true position, of either kind of reading."""
    kind = "position" if "position/t" in signals else "pose"
    x, y = (signals[f"{kind}/measured"] - signals[f"{kind}/true"])[:, :2].T
    return np.asarray(np.hypot(x, y))


def mean(values: Column) -> float:
    """Returns the mean of what is known; raises Missing where nothing is."""
    known = values[np.isfinite(values)]
    if not len(known):
        raise Missing("there is no value to take the mean of")
    return float(known.mean())


def spread(values: Column) -> float:
    """Returns the standard deviation of what is known; raises Missing for less than two values."""
    known = values[np.isfinite(values)]
    if len(known) < 2:
        raise Missing("there are too few values for a standard deviation")
    return float(known.std(ddof=1))
