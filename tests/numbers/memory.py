"""Measures memory in a process of its own: `python -m tests.numbers.memory within|between FOLDER`."""

from __future__ import annotations

import gc
import json
import os
import resource
import sys
from pathlib import Path

from hilbed.clock import SECOND
from hilbed.record.folder import RunFolder
from hilbed.runner import Watch, perform
from hilbed.scenario.load import load
from hilbed.types import Cycle


def resident() -> float:
    """Returns what this process holds in memory, MB."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def within(folder: Path) -> tuple[float, float]:
    """Returns what a run with all recorders holds after 4 s and after 14 s of simulated time."""
    held = {}

    def look(cycle: Cycle) -> None:
        if cycle.t in (4 * SECOND, 14 * SECOND):
            held[cycle.t] = resident()

    perform(load("demo", ["duration=14.5"]), RunFolder(folder / "run"), Watch(cycle=look))
    early, later = held.values()
    return early, later


def between(folder: Path) -> tuple[float, float]:
    """Returns what the process holds after the third run and after the eighth."""
    held = []
    for k in range(8):
        perform(load("demo", ["duration=0.5"]), RunFolder(folder / str(k)))
        gc.collect()
        held.append(resident())
    return held[2], held[7]


if __name__ == "__main__":
    early, later = {"within": within, "between": between}[sys.argv[1]](Path(sys.argv[2]))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    print(json.dumps({"early": early, "later": later, "peak": peak}))
