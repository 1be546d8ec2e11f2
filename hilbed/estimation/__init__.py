"""Estimators: from odometry and readings to a pose and its covariance."""
