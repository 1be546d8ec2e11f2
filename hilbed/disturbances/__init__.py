"""Disturbances: one function each, switched on and off by the scenario."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hilbed.disturbances.bodies import Push, SlipPatch, WheelRadius, push, slip_patch, wheel_radius
from hilbed.disturbances.bus import BusFault, babbling_node, bus_off, frame_fault, lost_heartbeat, node_reset
from hilbed.disturbances.commands import CommandNoise, command_noise
from hilbed.disturbances.drives import LoadTorque, SupplySag, load_torque, supply_sag
from hilbed.disturbances.schedule import Disturbance, Schedule
from hilbed.disturbances.sensors import SensorLoss, SensorNan, sensor_loss, sensor_nan
from hilbed.disturbances.vision import CameraLoss, SpuriousAzimuths, camera_loss, spurious_azimuths
from hilbed.types import Rng

DISTURBANCES: dict[str, Callable[[Any, int, Rng], Disturbance]] = {
    "load_torque": load_torque,
    "slip_patch": slip_patch,
    "wheel_radius": wheel_radius,
    "push": push,
    "supply_sag": supply_sag,
    "command_noise": command_noise,
    "spurious_azimuths": spurious_azimuths,
    "camera_loss": camera_loss,
    "sensor_loss": sensor_loss,
    "sensor_nan": sensor_nan,
    "drop": frame_fault,
    "corrupt": frame_fault,
    "delay": frame_fault,
    "duplicate": frame_fault,
    "babbling_node": babbling_node,
    "bus_off": bus_off,
    "lost_heartbeat": lost_heartbeat,
    "node_reset": node_reset,
}

DisturbanceSpec = (
    LoadTorque | SlipPatch | WheelRadius | Push | SupplySag
    | CommandNoise | SpuriousAzimuths | CameraLoss | SensorLoss | SensorNan | BusFault
)  # fmt: skip

__all__ = ["DISTURBANCES", "Disturbance", "DisturbanceSpec", "Schedule"]
