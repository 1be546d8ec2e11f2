"""Whether an estimator's doubt matches its errors: NEES and NIS with their chi-square bounds.

Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and Navigation (2001), section 5.4.
"""

from __future__ import annotations

import numpy as np

from hilbed.types import Array


def pose_error(estimate: Array, truth: Array) -> Array:
    """Returns estimate − truth (N, 3) of poses x, y (m), yaw (rad), the yaw in (−π, π]."""
    error: Array = np.subtract(estimate, truth)
    error[..., 2] = np.pi - np.mod(np.pi - error[..., 2], 2 * np.pi)
    return error


def nees(error: Array, covariance: Array) -> Array:
    """Returns the normalised estimation error squared eᵀ P⁻¹ e (N,) of errors (N, n), covariances (N, n, n).

    NaN where either is not finite or a covariance is not positive definite.
    """
    values = np.full(len(error), np.nan)
    finite = np.flatnonzero(np.isfinite(error).all(axis=1) & np.isfinite(covariance).all(axis=(1, 2)))
    sound = finite[np.linalg.eigvalsh(covariance[finite]).min(axis=1, initial=np.inf) > 0]
    e = error[sound]
    values[sound] = np.einsum("ni,ni->n", e, np.linalg.solve(covariance[sound], e[..., None])[..., 0])
    return values


def mean_bounds(dof: int, count: int, probability: float = 0.95) -> tuple[float, float]:
    """Returns the interval in which the mean of `count` independent NEES or NIS lies with `probability`.

    dof: degrees of freedom of one; count · mean is chi-square with count · dof.
    """
    from scipy.stats import chi2

    tail = (1 - probability) / 2
    return (
        float(chi2.ppf(tail, count * dof)) / count,
        float(chi2.ppf(1 - tail, count * dof)) / count,
    )
