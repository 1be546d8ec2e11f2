"""The body of a scenario's robot: its URDF with the scenario's geometry."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from hilbed.plant.urdf import Body, diffdrive
from hilbed.plant.urdf_tricycle import tricycle


def body_of(robot: Any, path: Path) -> Body:
    """Returns what a robot's block makes of the URDF at `path`; raises ScenarioError."""
    return BODIES[robot.kind](robot, path)


BODIES: dict[str, Callable[[Any, Path], Body]] = {
    "diffdrive": lambda robot, path: diffdrive(path, robot.wheel_radius, robot.track),
    "tricycle": lambda robot, path: tricycle(
        path, robot.wheel_radius, robot.track, robot.wheelbase, robot.drive
    ),
}
