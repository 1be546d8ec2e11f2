"""Sensors: sampled at a rate, delivered after a latency, sometimes not at all."""

from hilbed.sensors.camera import CameraSpec

SensorSpec = CameraSpec

__all__ = ["CameraSpec", "SensorSpec"]
