"""Robots: their kinematics and what their frames mean."""

from hilbed.robots.diffdrive import DiffDrive, DiffDriveSpec

ROBOTS = {"diffdrive": DiffDrive}

RobotSpec = DiffDriveSpec

__all__ = ["ROBOTS", "DiffDrive", "DiffDriveSpec", "RobotSpec"]
