"""Disturbances: one function each, switched on and off by the scenario."""

from hilbed.disturbances.bodies import Push, SlipPatch, WheelRadius, push, slip_patch, wheel_radius
from hilbed.disturbances.drives import LoadTorque, SupplySag, load_torque, supply_sag
from hilbed.disturbances.schedule import Disturbance, Schedule
from hilbed.disturbances.vision import CameraLoss, SpuriousAzimuths, camera_loss, spurious_azimuths

DISTURBANCES = {
    "load-torque": load_torque,
    "slip-patch": slip_patch,
    "wheel-radius": wheel_radius,
    "push": push,
    "supply-sag": supply_sag,
    "spurious-azimuths": spurious_azimuths,
    "camera-loss": camera_loss,
}

DisturbanceSpec = LoadTorque | SlipPatch | WheelRadius | Push | SupplySag | SpuriousAzimuths | CameraLoss

__all__ = ["DISTURBANCES", "Disturbance", "DisturbanceSpec", "Schedule"]
