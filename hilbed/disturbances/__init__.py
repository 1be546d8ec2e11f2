"""Disturbances: one function each, switched on and off by the scenario."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hilbed.disturbances.bodies import Push, SlipPatch, WheelRadius, push, slip_patch, wheel_radius
from hilbed.disturbances.drives import LoadTorque, SupplySag, load_torque, supply_sag
from hilbed.disturbances.schedule import Disturbance, Schedule
from hilbed.disturbances.vision import CameraLoss, SpuriousAzimuths, camera_loss, spurious_azimuths
from hilbed.types import Rng

DISTURBANCES: dict[str, Callable[[Any, int, Rng], Disturbance]] = {
    "load_torque": load_torque,
    "slip_patch": slip_patch,
    "wheel_radius": wheel_radius,
    "push": push,
    "supply_sag": supply_sag,
    "spurious_azimuths": spurious_azimuths,
    "camera_loss": camera_loss,
}

DisturbanceSpec = LoadTorque | SlipPatch | WheelRadius | Push | SupplySag | SpuriousAzimuths | CameraLoss

__all__ = ["DISTURBANCES", "Disturbance", "DisturbanceSpec", "Schedule"]
