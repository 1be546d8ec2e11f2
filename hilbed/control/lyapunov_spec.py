"""Scenario block of the Lyapunov tracking law."""

from __future__ import annotations

from typing import Literal

from hilbed.spec import Positive, Spec


class LyapunovTrackingSpec(Spec):
    """Gains of (3.13): k1 1/s, k2 rad/m², k3 rad/m; (3.17) has 0.5 for each."""

    kind: Literal["lyapunov"] = "lyapunov"
    k1: Positive = 0.5
    k2: Positive = 0.5
    k3: Positive = 0.5
