"""The key to the letters over a page's figures."""

from __future__ import annotations

import re
from math import inf
from pathlib import Path

from hilbed.criteria import Signals
from hilbed.paper.upsets import acting
from hilbed.report.run import Run, Span

LOADED = """
sensors:
  camera: {kind: camera, rate: 50.0, latency: 0.05, width: 640, noise: 0.0005, missed: 0.05, spurious: 0.0}
disturbances:
- {start: 0.0, length: null, kind: wheel_radius, drive: left, size: 1.0, spread: 0.003}
- {start: 1.5, length: 1.0, kind: load_torque, drive: right, size: 3.0, shape: step, rise: 1.0}
"""
SPANS = (Span("A", "wheel radius · left", 0.0, inf), Span("B", "load torque · right", 1.5, 2.5))


def run(scenario: str = "", spans: tuple[Span, ...] = ()) -> Run:
    return Run(Path(), scenario, {}, Signals(), spans, (), ())


def words(text: str | None) -> list[str]:
    return [word.strip() for word in re.split(r"<[^>]*>", text or "") if word.strip()]


def test_letters_sizes_and_times_of_a_twin_with_what_its_sensors_do_wrong() -> None:
    runs = {"p/a": run(), "p/a-bench": run(LOADED, SPANS)}
    assert words(acting(["p/a"], runs)) == [
        *("a-bench", "camera", "rate 50, latency 0.05, noise 0.0005, missed 0.05"),
        *("A", "wheel radius · left", "size 1, spread 0.003, all the time"),
        *("B", "load torque · right", "size 3, 1.5–2.5 s"),
    ]


def test_scenarios_with_the_same_stand_together() -> None:
    same = run(LOADED, SPANS)
    told = words(acting(["p/a", "p/b"], {"p/a-bench": same, "p/b-bench": same}))
    assert told[0] == "a-bench, b-bench"
    assert told.count("A") == 1


def test_where_nothing_acts_there_is_nothing_to_tell() -> None:
    assert acting(["p/a", "p/b"], {"p/a": run("sensors: {}"), "p/b": run("disturbances: []")}) is None
