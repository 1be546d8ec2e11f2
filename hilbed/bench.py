"""`hilbed bench`: the floor that physics and renderer set, the total, and where the rest goes."""

from __future__ import annotations

import resource
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from hilbed.record.folder import RunFolder
from hilbed.runner import perform, processors
from hilbed.scenario.load import load

STARTS = 5


def bench(scenario: str) -> int:
    """Runs a scenario with all recorders on, prints its cost and returns the run's status.

    floor / total = (cost.physics + cost.render) / wall_time, both from the same run.
    """
    loaded = load(scenario, ["record=all"])
    with TemporaryDirectory(prefix="hilbed-bench-") as folder:
        outcome = perform(loaded, RunFolder(Path(folder) / "run"), separate=processors() > 1)
    verdict = outcome.verdict
    cost, wall, simulated = verdict["cost"], verdict["wall_time"], verdict["sim_time"]
    print(f"{loaded.name}: {simulated:g} s simulated in {wall:.2f} s, {simulated / wall:.1f} x real time")
    print(f"{'part':12}{'s':>9}{'ms a simulated s':>20}{'of the total':>14}")
    parts = {**cost, "other": wall - sum(cost.values())}
    for name, spent in parts.items():
        print(f"{name:12}{spent:9.3f}{1e3 * spent / simulated:20.2f}{spent / wall:14.1%}")
    floor = cost["physics"] + cost["render"]
    print(f"floor (physics + render) / total: {floor:.2f} s / {wall:.2f} s = {floor / wall:.3f}")
    print(f"peak memory: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")
    print(f"start-up of hilbed --help: {1e3 * help_time():.0f} ms (best of {STARTS})")
    return outcome.status


def help_time() -> float:
    """Returns the seconds that `hilbed --help` takes as a process, the best of a few."""
    times = []
    for _ in range(STARTS):
        start = perf_counter()
        subprocess.run([sys.executable, "-m", "hilbed", "--help"], check=True, capture_output=True)
        times.append(perf_counter() - start)
    return min(times)
