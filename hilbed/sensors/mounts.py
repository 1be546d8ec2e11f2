"""Where on the robot its sensors sit."""

from __future__ import annotations

from collections.abc import Mapping

from hilbed.sensors import PositionSpec, SensorSpec


def mounts(sensors: Mapping[str, SensorSpec]) -> dict[str, tuple[float, float]]:
    """Returns the place (m, robot's frame) of each sensor that looks at landmarks."""
    return {
        name: sensor.mount[:2] for name, sensor in sensors.items() if not isinstance(sensor, PositionSpec)
    }
