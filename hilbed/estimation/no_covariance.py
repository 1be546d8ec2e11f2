"""Estimators that say nothing of their doubt."""

from __future__ import annotations

from math import nan

import numpy as np

NO_COVARIANCE = np.full((3, 3), nan)
"""In place of a covariance (3, 3): NaN throughout."""
