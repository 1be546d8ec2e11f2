"""The nodes on a bus as the controller commands them, each in the way of its mode."""

from __future__ import annotations

from collections.abc import Iterable

from hilbed.can.axis import Axis
from hilbed.can.set_point import SetPointStation
from hilbed.can.station import Station

STATIONS: dict[str, type[Station]] = {"pp": SetPointStation}
"""By mode; in all others a target acts by its coming."""


def stations(axes: Iterable[Axis]) -> tuple[Station, ...]:
    """Groups axes by their node, which is in one mode."""
    found: dict[int, list[Axis]] = {}
    for axis in axes:
        found.setdefault(axis.node.id, []).append(axis)
    return tuple(STATIONS.get(group[0].node.mode, Station)(group) for group in found.values())
