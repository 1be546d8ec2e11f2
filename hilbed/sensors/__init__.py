"""Sensors: sampled at a rate, delivered after a latency, sometimes not at all."""

from hilbed.sensors.camera import CameraSpec
from hilbed.sensors.landmarks import BearingSpec, RangeBearingSpec
from hilbed.sensors.position import PositionSpec

SensorSpec = CameraSpec | PositionSpec | BearingSpec | RangeBearingSpec

__all__ = ["BearingSpec", "CameraSpec", "PositionSpec", "RangeBearingSpec", "SensorSpec"]
