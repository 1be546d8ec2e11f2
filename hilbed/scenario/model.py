"""The scenario: one model that collects those of all parts."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from hilbed.can.specs import BusSpec, NodeSpec, TerminalSpec, with_table
from hilbed.control import ControllerSpec, ReferenceSpec
from hilbed.criteria import CriterionSpec
from hilbed.disturbances import DisturbanceSpec
from hilbed.estimation import EstimatorSpec
from hilbed.pacer import RealtimeSpec
from hilbed.plant import PlantSpec
from hilbed.robots import DiffDriveSpec, RobotSpec
from hilbed.sensors import SensorSpec
from hilbed.spec import Positive, Spec, Word
from hilbed.vision.judging import VisionSpec

ByKind = Field(discriminator="kind")


def _diffdrive(value: Any) -> Any:
    return {"kind": "diffdrive", **value} if isinstance(value, dict) else value


DIFFDRIVE_BY_DEFAULT = BeforeValidator(_diffdrive)
"""On the robot's block: without a kind it is a differential drive."""


def _tables(value: Any) -> Any:
    if not isinstance(value, dict):
        return value
    return {name: with_table(name, block) for name, block in value.items()}


TABLES_BY_NAME = BeforeValidator(_tables)
"""On the drives: the steering axis is of the type that holds a position."""


class Scenario(Spec):
    """One experiment: duration and period in s; blocks as their own models say.

    terminal: a channel of its own for the pins of `ecu` nodes, else the bus carries them; real_speed_limit:
    m/s of the rim of a wheel whose drive is real.
    """

    seed: Annotated[int, Field(ge=0, lt=2**63)] = 0
    duration: Positive
    period: Positive = 0.01
    robot: Annotated[RobotSpec, ByKind, DIFFDRIVE_BY_DEFAULT, Word] = DiffDriveSpec()
    plant: Annotated[PlantSpec, ByKind, Word]
    nodes: Annotated[dict[str, Annotated[NodeSpec, Word]], TABLES_BY_NAME] = {}
    bus: Annotated[BusSpec, Word] = BusSpec()
    terminal: TerminalSpec | None = None
    real_speed_limit: Positive = 0.1
    sensors: dict[str, Annotated[SensorSpec, ByKind, Word]] = {}
    estimator: Annotated[EstimatorSpec, ByKind, Word]
    controller: Annotated[ControllerSpec, ByKind, Word] | None = None
    reference: Annotated[ReferenceSpec, ByKind] | None = None
    disturbances: list[Annotated[DisturbanceSpec, ByKind]] = []
    criteria: dict[str, CriterionSpec] = {}
    realtime: RealtimeSpec | None = None
    vision: VisionSpec | None = None
    record: Literal["all", "signals", "none"] = "all"
    versions: dict[str, str] = {}
