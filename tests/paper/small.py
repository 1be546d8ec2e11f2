"""A paper of a few short experiments, run in threads of this process, once for many tests."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from hilbed.paper import runs
from hilbed.paper.catalogue import Paper
from hilbed.paper.command import Options, publish

ONE, TWO, SEEN = "bui2022/test1-type1", "bui2022/test1-type2", "pliego2023/observer-so2"

CONTENT: dict[str, Any] = {
    "title": "A small paper",
    "mended": ["a < b"],
    "free": ["one", "two"],
    "sections": [
        {
            "title": "Circles",
            "text": "Both types.",
            "figures": [
                {"name": "Fig. 7", "caption": "paths", "draw": "paths", "scenarios": [ONE, TWO]},
                {"caption": "errors", "draw": "tracked", "scenarios": [ONE]},
                {
                    "caption": "fan",
                    "draw": "paths",
                    "scenarios": [ONE],
                    "vary": {"path": "robot.wheelbase", "values": [1.0, 1.5]},
                },
            ],
            "claims": [
                {"what": "radius", "law": "1.7320", "scenario": ONE, "ours": "turning_radius"},
                {"what": "pose", "printed": "left", "scenario": TWO, "ours": "final"},
                {"what": "time", "scenario": ONE, "ours": "cost/estimator"},
            ],
            "table": {"scenarios": [ONE], "seeds": [3, 5], "mean": [-1.7, 1.2, -1.3], "std": [0.1] * 3},
        },
    ],
}


def small(**changes: Any) -> Paper:
    """Returns the small paper, with other values at its top."""
    return Paper.model_validate(CONTENT | changes)


def in_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lets the pool of processes be one thread: quick, and what a test has changed is changed there, too."""
    monkeypatch.setattr(runs, "ProcessPoolExecutor", lambda *_, **__: ThreadPoolExecutor(1))


def published(monkeypatch: pytest.MonkeyPatch, folder: Path, paper: Paper, **options: Any) -> tuple[int, str]:
    """Returns the exit status and the page."""
    in_threads(monkeypatch)
    status = publish("small", paper, Options(folder, ideal=True, **options))
    return status, (folder / "paper.html").read_text()
