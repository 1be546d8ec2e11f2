"""`hilbed bench`: the floor that physics and renderer set, the total, where the rest goes; particles."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

from hilbed import bench_particles, compiled
from hilbed.clock import nanos
from hilbed.record.folder import RunFolder
from hilbed.runner import Watch, perform, processors
from hilbed.scenario.load import load
from hilbed.types import Cycle, Nanos

STARTS = 5


def bench(scenario: str) -> int:
    """Runs a scenario with all recorders on, prints its cost and that of particles; returns the run's status.

    floor / total = (cost.physics + cost.render) / wall_time, both from the same run. On two processors or
    more the camera renders and detects in a process of its own, and another one writes the logs.
    """
    loaded = load(scenario, ["record=all"])
    memory = Memory(nanos(loaded.scenario.duration))
    with TemporaryDirectory(prefix="hilbed-bench-") as folder:
        run, watch = RunFolder(Path(folder) / "run"), Watch(cycle=memory.look)
        outcome = perform(loaded, run, watch, separate=processors() > 1)
    verdict = outcome.verdict
    if not verdict["sim_time"]:
        print(f"{loaded.name}: {verdict['reason']}", file=sys.stderr)
        return outcome.status
    print(_table(loaded.name, verdict))
    print(f"firmware, bus, plant and EKF: {'compiled' if compiled.active() else 'from their sources'}")
    print(memory.text())
    print(f"start-up of hilbed --help: {1e3 * help_time():.0f} ms (best of {STARTS})")
    print(bench_particles.report())
    return outcome.status


class Memory:
    """The most memory that the bench and the processes beside it have held by the end of a run."""

    def __init__(self, end: Nanos) -> None:
        self._end = end
        self._peaks: list[float] = []

    def look(self, cycle: Cycle) -> None:
        """Notes it with the last cycle."""
        if cycle.t == self._end:
            self._peaks = [peak for process in ("self", *_children()) if (peak := _peak(process))]

    def text(self) -> str:
        """Returns it as a line."""
        each = " + ".join(f"{peak:.0f}" for peak in self._peaks)
        return f"peak memory: {each} = {sum(self._peaks):.0f} MB (bench, processes beside it)"


def _children() -> list[str]:
    """Returns the numbers of this process's children, none where the system does not tell them."""
    with suppress(OSError):
        return Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()
    return []


def _peak(process: str) -> float:
    """Returns the most MB that a process has held, 0 of one that has gone."""
    with suppress(OSError):
        status = Path(f"/proc/{process}/status").read_text()
        return int(status.partition("VmHWM:")[2].split()[0]) / 1024
    return 0.0


def _table(name: str, verdict: Mapping[str, Any]) -> str:
    cost, beside = verdict["cost"], verdict["cost_beside"]
    wall, simulated = verdict["wall_time"], verdict["sim_time"]
    rest = wall - sum(cost.values()) + sum(beside.values())
    lines = [
        f"{name}: {simulated:g} s simulated in {wall:.2f} s, {simulated / wall:.1f} x real time",
        f"{'part':12}{'s':>9}{'ms a simulated s':>20}{'of the total':>14}",
    ]
    for part, spent in {**cost, "the rest": rest}.items():
        apart = beside.get(part, 0.0)
        where = f"  {1e3 * apart / simulated:.2f} ms of it in a process beside" if apart else ""
        lines.append(f"{part:12}{spent:9.3f}{1e3 * spent / simulated:20.2f}{spent / wall:14.1%}{where}")
    floor = cost["physics"] + cost["render"]
    lines.append(f"floor (physics + render) / total: {floor:.2f} s / {wall:.2f} s = {floor / wall:.3f}")
    return "\n".join(lines)


def help_time() -> float:
    """Returns the seconds that `hilbed --help` takes as a process, the best of a few."""
    times = []
    for _ in range(STARTS):
        start = perf_counter()
        subprocess.run([sys.executable, "-m", "hilbed", "--help"], check=True, capture_output=True)
        times.append(perf_counter() - start)
    return min(times)
