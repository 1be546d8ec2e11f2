"""Scenario blocks of the estimators that see two landmarks at unknown distance: Ishikawa & Sampei (1994)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from hilbed.estimation.bearing_kalman import KalmanBucy, Noise, SampledKalman
from hilbed.estimation.bearing_observers import Luenberger, Lyapunov, Observer
from hilbed.estimation.specs import OdometrySpec
from hilbed.spec import Listed, Positive, Spec

Distance = Annotated[float, Field(ge=0.05, le=100)]
Variance = Annotated[float, Field(ge=1e-12, le=1e9)]


class BearingsSpec(Spec):
    """What the three share.

    distances (m): guessed r̂_A, r̂_B at the start; step (m): longest step of the integration; memory (s):
    how old a reading may be, and how long one may be missing before the next starts afresh.
    """

    distances: Listed[tuple[Distance, Distance]] = (1.0, 2.0**0.5)
    step: Annotated[float, Field(ge=1e-5, le=0.1)] = 5e-4
    memory: Annotated[float, Field(gt=0, le=60)] = 1.0

    def observer(self) -> Observer:
        """Returns the observer of one landmark."""
        raise NotImplementedError


class LyapunovObserverSpec(BearingsSpec):
    """Section 5.1 as printed; epsilon_2 = 2.0e-4 is what converges within the paper's run."""

    kind: Literal["bearing_lyapunov"] = "bearing_lyapunov"
    epsilon_1: Positive = 1.0e-2
    epsilon_2: Positive = 2.0e-3
    k: Positive = 4.0

    @model_validator(mode="after")
    def _positive_definite(self) -> LyapunovObserverSpec:
        if self.epsilon_2 <= self.epsilon_1**2:
            raise ValueError(
                f"epsilon_2 = {self.epsilon_2:g} must be above epsilon_1² = {self.epsilon_1**2:g}, "
                "or V is not positive definite"
            )
        return self

    def observer(self) -> Observer:
        return Lyapunov(self.epsilon_1, self.epsilon_2, self.k)


class BearingKalmanSpec(BearingsSpec):
    """Section 5.2; Q: m²/m and rad²/m; R: rad² m (bucy) or rad² (sampled); P0, free: m², rad²."""

    kind: Literal["bearing_kalman"] = "bearing_kalman"
    form: Literal["bucy", "sampled"] = "bucy"
    Q: Listed[tuple[Variance, Variance]] = (1.0e3, 0.2)
    R: Variance = 1.0e-3
    P0: Listed[tuple[Variance, Variance]] = (1.0, 0.1)

    def observer(self) -> Observer:
        noise = Noise(self.Q, self.R, self.P0)
        return KalmanBucy(noise) if self.form == "bucy" else SampledKalman(noise)


class LuenbergerSpec(BearingsSpec):
    """Section 5.3; poles are the roots of s² + p2 s + p1 (1/m); floor: least |sin φ̂| in the gain."""

    kind: Literal["bearing_luenberger"] = "bearing_luenberger"
    p1: Positive = 64.0
    p2: Positive = 16.0
    floor: Annotated[float, Field(ge=1e-3, le=1)] = 0.2

    def observer(self) -> Observer:
        return Luenberger(self.p1, self.p2, self.floor)


class SurveySpec(Spec):
    """The full state in one filter; not in the paper's simulations.

    distances (m) guessed at the start, and how wrong both may be, distance_std (m); std (rad): of a bearing,
    null for what the reading says; memory (s): how old a reading may be.
    """

    kind: Literal["bearing_survey"] = "bearing_survey"
    distances: Listed[tuple[Distance, Distance]] = (1.0, 2.0**0.5)
    distance_std: Positive = 1.0
    std: Annotated[float, Field(ge=1e-9, le=3.2)] | None = None
    odometry: OdometrySpec = OdometrySpec()
    memory: Annotated[float, Field(gt=0, le=60)] = 1.0
