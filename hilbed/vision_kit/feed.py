"""What `hilbed vision` does with frames that have no truth: images, videos, live cameras, recorded runs.

A detector's answers go to standard output as JSON lines, the time that it takes to standard error.
"""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from math import isfinite
from time import perf_counter
from typing import Any

from hilbed.vision.detectors import make_detector
from hilbed.vision.foreign import ForeignDetector
from hilbed.vision.seams import Closing, Detection, DetectionFailed, Detector, Shot, Source
from hilbed.vision_kit.sources import Task, check, open_source, subject_of, task_of


def feed(options: Namespace) -> int:
    """Shows frames to a detector; returns 0 where it had an answer to each of them, else 1."""
    check(options)
    subject = subject_of(options)
    task = task_of(subject, options)
    seconds: list[float] = []
    failed = 0
    with closing(open_source(options, subject)) as source, _opened(task, source) as detector:
        try:
            for k, shot in enumerate(_first(source.frames(), options.count)):
                start = perf_counter()
                answer = _answer(detector, shot)
                seconds.append(perf_counter() - start)
                failed += "failed" in answer
                line = {"frame": k, "t": shot.t / 1e9, "seconds": round(seconds[-1], 6), **answer}
                print(json.dumps(line), flush=True)
        finally:  # a live camera is ended by Ctrl-C
            print(_summary(source.name, seconds, failed), file=sys.stderr)
    return 1 if failed else 0


@contextmanager
def _opened(task: Task, source: Source) -> Iterator[Detector]:
    detector = make_detector(task.detector, source.lens, task.beacons, task.anonymous)
    try:
        yield detector
    finally:
        if isinstance(detector, Closing):
            detector.close()


def _first(shots: Iterator[Shot], count: int | None) -> Iterator[Shot]:
    for k, shot in enumerate(shots):
        yield shot
        if k + 1 == count:
            return


def _answer(detector: Detector, shot: Shot) -> dict[str, Any]:
    try:
        found = [_plain(one) for one in detector.detect(shot)]
        if isinstance(detector, ForeignDetector) and detector.said:
            print(detector.said.rstrip(), file=sys.stderr)
        return {"detections": found}
    except DetectionFailed as failed:
        trouble = failed.trouble
        print(f"{trouble.failure}: {trouble.text}\n{trouble.said}".rstrip(), file=sys.stderr)
        return {"detections": [], "failed": f"{trouble.failure}: {trouble.text}"}


def _plain(one: Detection) -> dict[str, float | int | None]:
    return {
        name: value if value is None or isfinite(value) else None for name, value in one._asdict().items()
    }


def _summary(name: str, seconds: Sequence[float], failed: int) -> str:
    if not seconds:
        return f"{name}: no frame"
    ordered = sorted(1e3 * one for one in seconds)
    median, late = ordered[len(ordered) // 2], ordered[min(len(ordered) - 1, len(ordered) * 95 // 100)]
    troubled = f", {failed} without an answer" if failed else ""
    times = f"{median:.2f} ms a frame (median), 95 % within {late:.2f} ms, at most {ordered[-1]:.2f} ms"
    return f"{name}: {len(seconds)} frames{troubled}; {times}"
