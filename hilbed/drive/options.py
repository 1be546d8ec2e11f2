"""The drive that the options of `hilbed drive` describe."""

from __future__ import annotations

import argparse

from pydantic import TypeAdapter, ValidationError

from hilbed.can.drive_table import load_table
from hilbed.drive.desk import Build
from hilbed.plant.gear import GEARS, GearSpec
from hilbed.plant.motor import MOTORS
from hilbed.spec import Finite, NonNegative, Positive
from hilbed.types import ScenarioError

_LIMITS: dict[str, TypeAdapter[float]] = {
    "inertia": TypeAdapter(Positive),
    "load": TypeAdapter(Finite),
    "friction": TypeAdapter(NonNegative),
    "supply": TypeAdapter(Positive),
    "angle": TypeAdapter(Finite),
    "switch": TypeAdapter(Finite),
}


def build_of(options: argparse.Namespace) -> Build:
    """Returns the drive that is asked for; ScenarioError with everything that is wrong."""
    problems: list[str] = []
    if not 1 <= options.node <= 127:
        problems.append(f"--node {options.node}: a node's number is 1 to 127")
    for name, limit in _LIMITS.items():
        if getattr(options, name) is not None:
            problems += _refused(f"--{name}", getattr(options, name), limit)
    if options.motor not in MOTORS:
        problems.append(f"--motor {options.motor}: the catalogue has {', '.join(MOTORS)}")
    gear = _gear(options.gear)
    if gear is None:
        problems.append(f"--gear {options.gear}: neither a positive ratio nor one of {', '.join(GEARS)}")
    try:
        units = load_table(options.table).units
    except ScenarioError as error:
        problems.append(f"--table: {error}")
    if problems or gear is None:
        raise ScenarioError("\n".join(problems))
    return Build(
        options.node,
        MOTORS[options.motor],
        gear,
        options.inertia,
        options.load,
        options.friction,
        round(units.counts_per_turn * units.gear),
        options.supply,
        options.angle,
        options.switch,
    )


def _refused(name: str, value: float, limit: TypeAdapter[float]) -> list[str]:
    try:
        limit.validate_python(value)
    except ValidationError as error:
        return [f"{name} {value:g}: {error.errors()[0]['msg'].lower()}"]
    return []


def _gear(text: str) -> GearSpec | None:
    if text in GEARS:
        return GEARS[text]
    try:
        return GearSpec(ratio=float(text))
    except ValueError:
        return None
