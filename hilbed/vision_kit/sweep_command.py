"""What `hilbed vision SCENARIO --sweep PATH=V1,V2` does: whole runs over one value of the camera."""

from __future__ import annotations

import json
from argparse import Namespace
from pathlib import Path

from hilbed.console import quiet_pipe
from hilbed.scenario.load import load
from hilbed.sweep import listed, parse_seeds
from hilbed.types import ScenarioError
from hilbed.vision_kit.archive import is_dataset
from hilbed.vision_kit.degradation import Task, content, run_sweep, table
from hilbed.vision_kit.labelled import LabelledShot
from hilbed.vision_kit.results import admit, keep
from hilbed.vision_kit.studio import Studio, Subject

PAGE, NUMBERS = "sweep.html", "sweep.json"


def sweep(options: Namespace) -> int:
    """Runs a scenario with each value, writes the page, and returns 0 where all criteria are met, else 1."""
    if is_dataset(options.scenario):
        raise ScenarioError(f"--sweep runs a scenario, and {options.scenario} is a dataset")
    task = Task(options.scenario, options.settings, options.detector, *listed("--sweep", options.sweep))
    subject = Subject(load(options.scenario, options.settings, options.seed, options.detector))
    folder: Path = options.out or Path("runs") / f"vision-{subject.name}-{task.path.rpartition('.')[2]}"
    admit(folder, NUMBERS, options.force)
    seeds = [subject.scenario.seed] if options.seeds is None else parse_seeds(options.seeds)
    done = run_sweep(task, seeds, options.jobs)
    from hilbed.vision_kit.degradation_page import write

    numbers = content(done)
    keep(folder, NUMBERS, numbers, PAGE, write(done, _frames(task, options.seed)))
    with quiet_pipe():
        print(json.dumps(numbers, indent=2) if options.json else f"{table(done)}\npage: {folder / PAGE}")
    return 0 if all(variant.passed == len(variant.results) for variant in done.variants) else 1


def _frames(task: Task, seed: int | None) -> list[LabelledShot]:
    """Returns what the camera sees from one place with each value."""
    frames = []
    for value in task.values:
        with Studio(Subject(task.load(value, seed))) as studio:
            frames.append(studio.take(0))
    return frames
