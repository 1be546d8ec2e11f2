"""What turns a wheel: a drive in this process, one whose firmware is elsewhere, one that is real."""

from __future__ import annotations

from hilbed.plant.axes.axis import Axis
from hilbed.plant.axes.ecu import EcuAxis
from hilbed.plant.axes.mirrored import MirroredAxis
from hilbed.plant.axes.real import RealAxis, RealSteeringAxis
from hilbed.plant.axes.simulated import SimulatedAxis, own_firmware
from hilbed.plant.axes.switched import HomeSwitch, SwitchedAxis, SwitchedEcuAxis

__all__ = [
    "Axis",
    "EcuAxis",
    "HomeSwitch",
    "MirroredAxis",
    "RealAxis",
    "RealSteeringAxis",
    "SimulatedAxis",
    "SwitchedAxis",
    "SwitchedEcuAxis",
    "own_firmware",
]
