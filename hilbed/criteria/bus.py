"""How busy the bus is and how long frames take, from t = 0 on: boot is not judged."""

from __future__ import annotations

import numpy as np

from hilbed.criteria.consistency import mean
from hilbed.criteria.pose import largest
from hilbed.criteria.signals import Column, Missing, Signals

SPAN = 0.1  # s over which the load is taken


def bus_load(signals: Signals) -> float:
    """Part of the time in which a frame or an error frame is on the bus."""
    return mean(load(signals)[1])


def bus_load_max(signals: Signals) -> float:
    """Part of the time in which a frame is on the bus, in the busiest 0.1 s."""
    return largest(load(signals)[1])


def bus_frames(signals: Signals) -> float:
    """Number of frames."""
    return float(np.count_nonzero(_received(signals)))


def bus_latency_mean(signals: Signals) -> float:
    """Time from queueing a frame to its last bit, mean."""
    return mean(signals["bus/latency"][_received(signals)])


def bus_latency_max(signals: Signals) -> float:
    """Time from queueing a frame to its last bit, longest."""
    return largest(signals["bus/latency"][_received(signals)])


def bus_errors(signals: Signals) -> float:
    """Number of error frames."""
    return float(np.count_nonzero((signals["bus/t"] >= 0) & (signals["bus/error"] != 0)))


def _received(signals: Signals) -> Column:
    """Tells which rows are frames that got through."""
    return np.asarray((signals["bus/t"] >= 0) & (signals["bus/error"] == 0))


def load(signals: Signals) -> tuple[Column, Column]:
    """Returns the starts (n,) in s of all whole spans of 0.1 s and the part of each that frames take."""
    t, duration, cycles = signals["bus/t"], signals["bus/duration"], signals["t"]
    count = int(round((cycles[-1] - cycles[0]) / SPAN, 6)) if len(cycles) else 0
    if count < 1:
        raise Missing(f"the run is shorter than {SPAN} s")
    edges = cycles[0] + SPAN * np.arange(count + 1)
    busy, _ = np.histogram(t, edges, weights=duration)
    return edges[:-1], busy / SPAN
