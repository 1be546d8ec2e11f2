"""Runs the papers' twins on the bench over seeds; prints each criterion's worst value beside its limit.

`python scripts/twins.py [--seeds 1..20] [--jobs 1] [NAME …]`: names of twins, or their beginnings such as
`bui2022/`; all of them without. Exit status 1 where a run fails a criterion or does not get to its end.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor

from hilbed.scenario import bundled
from hilbed.scenario.load import load
from hilbed.sweep import Job, Result, parse_seeds, run_all, tabulate

ROW = "{:36} {:28} {:>10} {:>10} {:>5}  {}"


def twins(beginnings: Sequence[str]) -> list[str]:
    """Returns the twins whose names begin so; all where nothing is asked for."""
    found = [name for name in bundled.names() if name.endswith("-bench")]
    return [name for name in found if name.startswith(tuple(beginnings) or "")]


def rows(name: str, results: Sequence[Result]) -> list[str]:
    """Returns a line for each criterion: worst value over the seeds, limit, that seed, runs that met it."""
    criteria = load(name).scenario.criteria
    lines = []
    for line in tabulate(results)[: len(criteria)]:
        criterion = criteria[line.name]
        worst, bound = (line.high, "≤") if criterion.min is None else (line.low, "≥")
        limit = f"{bound} {criterion.max if criterion.min is None else criterion.min:.5g}"
        met = f"{line.passed} of {len(results)}"
        lines.append(ROW.format(name, line.name, f"{worst:.5g}", limit, line.worst, met))
    return lines


def main() -> int:
    """Runs what is asked for, twin by twin, and returns the exit status."""
    parser = argparse.ArgumentParser(description="The papers' twins on the bench, over seeds.")
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--seeds", default="1..20")
    parser.add_argument("--jobs", type=int, default=1)
    asked = parser.parse_args()
    failed = 0
    print(ROW.format("twin", "criterion", "worst", "limit", "seed", "met"))
    with ProcessPoolExecutor(asked.jobs, mp_context=multiprocessing.get_context("spawn")) as pool:
        for name in twins(asked.names):
            results = run_all([Job(name, (), seed) for seed in parse_seeds(asked.seeds)], pool)
            failed += sum(result.status != 0 for result in results)
            print("\n".join(rows(name, results)), flush=True)
            for result in results:
                if result.status > 1:
                    print(f"{name}, seed {result.job.seed}: {result.verdict['reason']}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
