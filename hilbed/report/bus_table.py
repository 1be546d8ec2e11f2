"""The frames of a run as a table: what each identifier is, how often it comes, where its latency goes."""

from __future__ import annotations

from typing import Any

import numpy as np

from hilbed.can.cob import CONTROLLER_ID, HEARTBEAT, NMT, SYNC
from hilbed.report.run import Run

NOTE = (
    "times in µs, mean · longest; queueing: until the bus was free; arbitration: other frames won, or an "
    "error frame ended an attempt; transfer: from the first bit to the last"
)

_FIXED = {NMT: "NMT", SYNC: "SYNC", HEARTBEAT + CONTROLLER_ID: "heartbeat, controller"}
_SERVICES = {
    0x080: "EMCY", 0x180: "TPDO1", 0x200: "RPDO1", 0x280: "TPDO2", 0x300: "RPDO2", 0x380: "TPDO3",
    0x400: "RPDO3", 0x480: "TPDO4", 0x500: "RPDO4", 0x580: "SDO answer", 0x600: "SDO request",
    0x700: "heartbeat",
}  # fmt: skip
_WORDS = ("identifier", "")
_NUMBERS = ("frames", "period [ms]", "queueing", "arbitration", "transfer", "error frames")

Times = np.ndarray[Any, Any]


def frames(run: Run) -> str | None:
    """Returns a row for each identifier, from t = 0 on; None without a bus."""
    signals = run.signals
    if "bus/arbitration" not in signals or not (signals["bus/t"] >= 0).any():
        return None
    identifiers = np.unique(signals["bus/id"][signals["bus/t"] >= 0]).tolist()
    rows = "".join(_row(run, identifier) for identifier in identifiers)
    head = "".join(f"<th>{word}</th>" for word in _WORDS) + "".join(
        f'<th class="number">{word}</th>' for word in _NUMBERS
    )
    table = f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
    return f'<div class="scroll">{table}</div>'


def name_of(identifier: int) -> str:
    """Returns what an identifier is in CANopen's predefined connection set, empty where it is none of it."""
    service = _SERVICES.get(identifier & 0x780)
    node = f"{service}, node {identifier & 0x7F}" if service and identifier <= 0x7FF else ""
    return _FIXED.get(identifier, node)


def _row(run: Run, identifier: int) -> str:
    signals = run.signals
    chosen = (signals["bus/id"] == identifier) & (signals["bus/t"] >= 0)
    through = chosen & (signals["bus/error"] == 0)
    errors = int(np.count_nonzero(chosen)) - int(np.count_nonzero(through))
    t, latency, duration, arbitration = (
        signals[f"bus/{name}"][through] for name in ("t", "latency", "duration", "arbitration")
    )
    period = f"{1e3 * np.median(np.diff(t - latency)):.4g}" if len(t) > 1 else ""
    times = (latency - duration - arbitration, arbitration, duration)
    cells = [str(len(t)), period, *map(_times, times), str(errors) if errors else ""]
    numbers = "".join(f'<td class="number">{cell}</td>' for cell in cells)
    return f"<tr><th><code>0x{identifier:03X}</code></th><td>{name_of(identifier)}</td>{numbers}</tr>"


def _times(values: Times) -> str:
    """Returns mean and longest in µs; where nothing was waited for, rounding leaves a little less."""
    values = np.maximum(values, 0.0)
    return f"{1e6 * values.mean():.0f} · {1e6 * values.max():.0f}" if len(values) else ""
