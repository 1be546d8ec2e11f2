"""What a scenario may name is what can be built: kinds of the specs and rows of the tables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, get_args

import pytest

from hilbed.build.minds import CONTROLLERS, ESTIMATORS
from hilbed.build.senses import SENSORS
from hilbed.control import ControllerSpec
from hilbed.disturbances import DISTURBANCES, DisturbanceSpec
from hilbed.estimation import EstimatorSpec
from hilbed.plant import PlantSpec
from hilbed.robots import ROBOTS, RobotSpec
from hilbed.sensors import SensorSpec


def kinds(union: Any) -> list[str]:
    """Returns the kinds of a union of specs, or of a single one."""
    members: Iterable[Any] = get_args(union) or (union,)
    return [get_args(member.model_fields["kind"].annotation)[0] for member in members]


@pytest.mark.parametrize(
    ("union", "table"),
    [
        (RobotSpec, ROBOTS),
        (DisturbanceSpec, DISTURBANCES),
        (EstimatorSpec, ESTIMATORS),
        (ControllerSpec, CONTROLLERS),
        (SensorSpec, SENSORS),
        (PlantSpec, dict.fromkeys(("bullet", "kinematic", "recorded"))),
    ],
)
def test_every_kind_has_a_row_and_every_row_a_kind(union: Any, table: Mapping[str, Any]) -> None:
    assert sorted(kinds(union)) == sorted(table)
