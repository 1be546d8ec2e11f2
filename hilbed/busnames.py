"""Which python-can bus a run is on: from the command line and from where python-can looks, to the scenario.

A run is simulated unless it is told otherwise: by -i or -c, by CAN_INTERFACE, or by the scenario. Only then
are python-can's files (~/.canrc) asked for what is left open.
"""

from __future__ import annotations

import json
import os
from typing import NamedTuple

from hilbed.can.specs import WIRE, BusSpec


class Asked(NamedTuple):
    """What the command line says, or the scenario, or both."""

    interface: str | None = None
    channel: str | int | None = None
    bitrate: int | None = None


def bus_settings(asked: Asked, bus: BusSpec) -> list[str]:
    """Returns the bus as settings to lay over the scenario; ScenarioError where there is no such interface.

    What the command line says goes before the scenario, and that before CAN_INTERFACE and the files.
    """
    known = _with_scenario(asked, bus)
    elsewhere = asked.channel is not None or bus.carried or _environment(bus)
    if known.interface == WIRE or (known.interface is None and not elsewhere):
        return _settings(asked)
    from hilbed.can.driver import resolve

    return _settings(Asked(*resolve(*known)))


def _environment(bus: BusSpec) -> bool:
    """Tells whether CAN_INTERFACE asks for a bus and the scenario leaves that open."""
    return bool(os.environ.get("CAN_INTERFACE")) and "interface" not in bus.model_fields_set


def _with_scenario(asked: Asked, bus: BusSpec) -> Asked:
    """Returns what is asked for, with the scenario's words where the command line has none."""
    interface = asked.interface or bus.interface
    same = bus.carried and interface == bus.interface
    channel = bus.channel if asked.channel is None and same else asked.channel
    bitrate = bus.bitrate if asked.bitrate is None and "bitrate" in bus.model_fields_set else asked.bitrate
    return Asked(interface, channel, bitrate)


def _settings(asked: Asked) -> list[str]:
    return [f"bus.{key}={json.dumps(value)}" for key, value in asked._asdict().items() if value is not None]
