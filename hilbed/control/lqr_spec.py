"""Scenario block of the linear-quadratic regulator."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from hilbed.spec import Listed, Positive, Spec

Weight = Annotated[float, Field(ge=1e-4, le=1e4)]


class LqrSpec(Spec):
    """Weights in Bryson's form: the error and the effort that are felt to be equally bad.

    error: along m, across m, yaw rad; effort: speed m/s, yaw rate rad/s; max_speed m/s and max_turn_rate
    rad/s limit the command. The defaults give Q = 400 I, R = 400 I.
    """

    kind: Literal["lqr"] = "lqr"
    error: Listed[tuple[Weight, Weight, Weight]] = (0.05, 0.05, 0.05)
    effort: Listed[tuple[Weight, Weight]] = (0.05, 0.05)
    max_speed: Positive = 1.0
    max_turn_rate: Annotated[float, Field(gt=0, le=20)] = 2.0
