"""What comes between the controller's command and the drives."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Literal

from pydantic import Field

from hilbed.clock import nanos
from hilbed.disturbances.schedule import Disturbance, DisturbanceBase
from hilbed.effects import Effects, Surroundings
from hilbed.ports import Base
from hilbed.spec import Listed, NonNegative
from hilbed.types import Command, Nanos, Odometry, Rng


class CommandNoise(DisturbanceBase):
    """Normal noise on the command, drawn anew every `hold` s; the robot's limits hold for the sum.

    size: standard deviations (m/s, and rad/s, or rad of steering). Bui & Duong (2022), section 3.2, has
    [0, 0.3] (variance 0.09 rad²) with a hold of 0.1 s.
    """

    kind: Literal["command_noise"] = "command_noise"
    size: Listed[tuple[NonNegative, NonNegative]]
    hold: Annotated[float, Field(ge=0.001, le=1000)] = 0.1


def command_noise(spec: CommandNoise, _: int, rng: Rng) -> Disturbance:
    """Returns the disturbance that adds noise to the command."""
    hold = nanos(spec.hold)
    draws: list[tuple[float, float]] = []  # one for each hold that has begun

    def apply(since: Nanos, _: Surroundings, effects: Effects) -> Nanos:
        number, into = divmod(since, hold)
        while len(draws) <= number:
            first, second = rng.standard_normal(2).tolist()
            draws.append((spec.size[0] * first, spec.size[1] * second))
        v, w = effects.command
        effects.command = (v + draws[number][0], w + draws[number][1])
        return hold - into

    return apply


class DisturbedBase:
    """A base whose commands are disturbed on their way; what its encoders say is what the drives did."""

    def __init__(
        self, base: Base, limited: Callable[[Command], Command], effects: Callable[[Nanos], Effects]
    ) -> None:
        """limited: a command as the robot takes it; effects: of the disturbances at a time."""
        self._base = base
        self._limited = limited
        self._effects = effects

    def read(self, t: Nanos) -> Odometry:
        """Returns what the base measures."""
        return self._base.read(t)

    def write(self, t: Nanos, command: Command) -> None:
        """Passes the command on, with what disturbs it now."""
        v, w = self._effects(t).command
        disturbed = v != 0.0 or w != 0.0
        self._base.write(t, self._limited(Command(command.v + v, command.w + w)) if disturbed else command)
