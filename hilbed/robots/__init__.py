"""Robots: their kinematics and what their frames mean."""

from collections.abc import Callable
from typing import Any

from hilbed.ports import Robot
from hilbed.robots.diffdrive import DiffDrive, DiffDriveSpec
from hilbed.robots.tricycle import Tricycle, TricycleSpec

RobotSpec = DiffDriveSpec | TricycleSpec

ROBOTS: dict[str, Callable[[Any], Robot]] = {"diffdrive": DiffDrive, "tricycle": Tricycle}

__all__ = ["ROBOTS", "DiffDrive", "DiffDriveSpec", "RobotSpec", "Tricycle", "TricycleSpec"]
