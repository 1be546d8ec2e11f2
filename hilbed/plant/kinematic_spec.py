"""Scenario block of the ideal plant."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Literal

from pydantic import Field

from hilbed.plant.kinematic import Vehicle
from hilbed.plant.kinematics import INTEGRATORS, Twist, TwistNoise
from hilbed.scene import BeaconSpec, SceneryBlock, ScenerySpec
from hilbed.spec import Listed, NonNegative, Spec
from hilbed.types import Command, Rng


class KinematicSpec(Spec):
    """How an ideal robot moves, and the noise on it, drawn once a control period and held over it.

    beacons, scenery: what its sensors see; start_std (m, m, rad): how wrong the estimator is told the
    start, standard deviations, drawn once; integrator, and its steps a period; command_noise: standard
    deviations added to the command (m/s, and rad/s or rad of steering) before the robot's limits;
    twist_noise: σ_t (m per m) and σ_D (rad per m).
    """

    kind: Literal["kinematic"] = "kinematic"
    beacons: list[BeaconSpec] = []
    scenery: SceneryBlock = ScenerySpec()
    start_std: Listed[tuple[NonNegative, NonNegative, NonNegative]] = (0.0, 0.0, 0.0)
    integrator: Literal["exact", "rk4", "euler"] = "exact"
    steps: Annotated[int, Field(ge=1, le=1000)] = 1
    command_noise: Listed[tuple[NonNegative, NonNegative]] = (0.0, 0.0)
    twist_noise: Listed[tuple[NonNegative, NonNegative]] = (0.0, 0.0)


def make_vehicle(
    spec: KinematicSpec,
    twist: Callable[[Command], Twist],
    limited: Callable[[Command], Command],
    rng: Rng,
) -> Vehicle:
    """Returns a robot for the ideal plant: what its commands give, what it takes, its noise from `rng`."""
    first, second = spec.command_noise
    noise = TwistNoise(*spec.twist_noise)

    def command_noise(command: Command) -> Command:
        return Command(command[0] + rng.normal(0.0, first), command[1] + rng.normal(0.0, second))

    return Vehicle(
        twist,
        limited,
        command_noise,
        lambda moved: noise.disturbed(moved, rng),
        INTEGRATORS[spec.integrator],
        spec.steps,
    )
