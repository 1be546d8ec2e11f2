"""What an estimator believes of an odometer."""

from __future__ import annotations

from typing import NamedTuple


class OdometryModel(NamedTuple):
    """What is known about an odometer: its systematic errors and its noise.

    direction: of travel in the robot's frame (rad), 0 where wheels and frame are aligned; scales: true
    over told; noise: standard deviations that grow with the root of the way: distance (m/√m), heading
    (rad/√m), and heading from turning (rad/√rad).
    """

    direction: float = 0.0
    distance_scale: float = 1.0
    turn_scale: float = 1.0
    distance_noise: float = 0.05
    heading_noise: float = 0.1
    turn_noise: float = 0.05
