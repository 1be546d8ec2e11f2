"""How well a run in real time has kept its time; other runs have none of these numbers."""

from __future__ import annotations

import numpy as np

from hilbed.criteria.pose import largest
from hilbed.criteria.signals import Missing, Signals


def missed_deadlines(signals: Signals) -> float:
    """Number of cycles that began too late for their commands to be sent."""
    return float(np.count_nonzero(signals["realtime/missed"]))


def lateness_p99(signals: Signals) -> float:
    """Time by which a cycle began after its deadline, 99th percentile."""
    lateness = signals["realtime/lateness"]
    if not len(lateness):
        raise Missing("no cycle has begun")
    return float(np.percentile(lateness, 99))


def lateness_max(signals: Signals) -> float:
    """Time by which a cycle began after its deadline, longest."""
    return largest(signals["realtime/lateness"])
