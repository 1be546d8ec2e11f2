"""What `hilbed vision` does: a detector on labelled frames, its measures, a page and an exit status."""

from __future__ import annotations

import json
from argparse import Namespace
from collections.abc import Callable, Mapping
from math import isfinite
from pathlib import Path
from typing import Any

from hilbed import yaml12
from hilbed.console import end_progress, progress, quiet_pipe
from hilbed.scenario.load import resolved
from hilbed.versions import versions
from hilbed.vision.detectors import ForeignSpec
from hilbed.vision_kit.feed import feed
from hilbed.vision_kit.footage import footage, opened_detector, varied
from hilbed.vision_kit.measures import judge, measure
from hilbed.vision_kit.results import admit, keep
from hilbed.vision_kit.sources import is_feed
from hilbed.vision_kit.studio import Subject
from hilbed.vision_kit.trial import Rules, Trial, joined, run_trial

PAGE, VERDICT = "vision.html", "vision.json"


def vision(options: Namespace) -> int:
    """Scores a detector on a scenario or a dataset, and returns 0 where all criteria are met, else 1."""
    if is_feed(options.scenario):
        return feed(options)
    if options.sweep is not None:
        from hilbed.vision_kit.sweep_command import sweep

        return sweep(options)
    subject, parts = _score(options)
    trial = joined(list(parts.values()))
    verdict = conclude(subject, trial)
    if options.vary is not None:
        verdict["varied"] = {setting: _finite(measure(part)) for setting, part in parts.items()}
    folder = _folder(options, subject)
    _write(folder, subject, trial, verdict)
    with quiet_pipe():
        print(json.dumps(verdict, indent=2) if options.json else _table(verdict, folder))
    return 0 if verdict["passed"] else 1


def _score(options: Namespace) -> tuple[Subject, dict[str, Trial]]:
    """Returns the trial with each setting of `--vary`, and the subject as it is with the first."""
    parts: dict[str, Trial] = {}
    subjects: list[Subject] = []
    for setting in varied(options):
        with footage(options, setting) as (subject, total, shots), opened_detector(subject) as detector:
            if not subjects:
                admit(_folder(options, subject), VERDICT, options.force)
            subjects.append(subject)
            rules = Rules(subject.vision.visible, subject.vision.distance)
            first = sum(part.frames for part in parts.values())
            try:
                parts[setting] = run_trial(shots, detector, rules, _teller(setting, first, total), first)
            finally:
                end_progress()
    return subjects[0], parts


def _teller(setting: str, first: int, total: int) -> Callable[[int], None]:
    return lambda k: progress(f"{setting} frame {k - first + 1} of {total}".strip())


def _folder(options: Namespace, subject: Subject) -> Path:
    return options.out or Path("runs") / f"vision-{subject.name}-{subject.scenario.seed}"


def _name(subject: Subject) -> str:
    """Returns what a detector is called: its kind, or its code without the way to it."""
    spec = subject.camera.detector
    return Path(spec.code).name if isinstance(spec, ForeignSpec) else spec.kind


def conclude(subject: Subject, trial: Trial) -> dict[str, Any]:
    """Returns the content of vision.json; numbers that are not finite are None."""
    values = measure(trial)
    judged = judge(values, subject.vision.criteria)
    reasons = [f"{name}: {entry['reason']}" for name, entry in judged.items() if not entry["passed"]]
    return {
        "scenario": subject.name,
        "seed": subject.scenario.seed,
        "detector": _name(subject),
        "passed": not reasons,
        "reason": "; ".join(reasons),
        "criteria": judged,
        "measures": _finite(values),
        "failed": {str(frame): why for frame, why in trial.failed.items()},
        "worst": [picture.frame for picture in trial.worst],
        "versions": versions(),
    }


def _finite(values: Mapping[str, float]) -> dict[str, float | None]:
    return {name: value if isfinite(value) else None for name, value in values.items()}


def _write(folder: Path, subject: Subject, trial: Trial, verdict: Mapping[str, Any]) -> None:
    from hilbed.vision_kit.page import write

    text = yaml12.write(resolved(subject.scenario, versions()))
    keep(folder, VERDICT, verdict, PAGE, write(subject, trial, verdict, text))


def _failures(failed: Mapping[str, str]) -> list[str]:
    """Returns the first of each kind of failure, which stands before the colon."""
    first: dict[str, str] = {}
    for frame, why in failed.items():
        first.setdefault(why.partition(":")[0], f"frame {frame}: {why}")
    return list(first.values())


def _table(verdict: Mapping[str, Any], folder: Path) -> str:
    from hilbed.vision.judging import MEASURES

    lines = []
    for name, value in verdict["measures"].items():
        shown = "none" if value is None else f"{value:.4g}"
        lines.append(f"{name:18} {shown:>10} {MEASURES[name].unit}".rstrip())
    for name, entry in verdict["criteria"].items():
        sign = "≤" if entry["bound"] == "max" else "≥"
        shown = "none" if entry["value"] is None else f"{entry['value']:.4g}"
        lines.append(f"{name}  {shown}  {sign} {entry['limit']:.4g}  {'pass' if entry['passed'] else 'FAIL'}")
    lines += _failures(verdict["failed"])
    word = "passed" if verdict["passed"] else "FAILED"
    return "\n".join(
        [*lines, f"{verdict['scenario']}, {verdict['detector']}: {word}", f"page: {folder / PAGE}"]
    )
