"""Scenario block of the control by a cloud of particles."""

from __future__ import annotations

from typing import Literal

from hilbed.spec import Listed, NonNegative, Positive, Spec


class CloudSpec(Spec):
    """Point stabilisation chosen by local support: Lages & Alves (2017).

    gamma_1, gamma_2 (1/s), h: gains of (16) and (17); radii: of the ellipse of support, m/s and rad/s;
    guard (m): for particles that are nearer to the goal ψ := 0, 0 for the law as printed, with which the
    yaw does not settle; wheel_speed (m/s) and half_track (m): |v| + half_track |w| ≤ wheel_speed.
    """

    kind: Literal["cloud"] = "cloud"
    gamma_1: Positive = 0.5
    gamma_2: Positive = 0.5
    h: Positive = 1.0
    radii: Listed[tuple[Positive, Positive]] = (0.05, 0.2)
    guard: NonNegative = 0.05
    wheel_speed: Positive = 0.471
    half_track: Positive = 0.25
