"""What an experiment can run into: it goes on with finite numbers, and the run says how often it happened."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
import pytest

from hilbed.record.folder import RunFolder
from hilbed.report import write_report
from hilbed.runner import perform
from hilbed.scenario.load import load
from tests.bench import ran

ISHIKAWA, BUI, LAGES, PLIEGO = "ishikawa1994/", "bui2022/", "lages2017/", "pliego2023/"
LANDMARKS = "sensors={eye: {kind: bearing, rate: 50}}"


def starts(x: float, y: float, yaw: float) -> tuple[str, str]:
    """A robot and its reference from a pose."""
    return f"robot.start=[{x}, {y}, {yaw}]", f"reference.start=[{x}, {y}, {yaw}]"


def nan_of(sensor: str) -> str:
    """One second of NaN."""
    return f"disturbances=[{{kind: sensor_nan, sensor: {sensor}, start: 0.5, length: 1}}]"


AXIS = starts(1, 0, pi)  # drives over landmark A, with B abeam
ON_A = starts(0, 0, 0.5)
FACING_BACK = "robot.start=[-20, 3, 2.5]"
EXACT = ("estimator.position_std=0.0001", "estimator.yaw_std=0.00001")  # no particle is that near
VAGUE = ("initial_std: [1.0e+6, 1.0e+6, 1.0e+6]", "azimuth: {std: 1.0e-9}", "range: {std: 1.0e-9}")
ROUNDED_OFF = f"estimator={{kind: ekf, {', '.join(VAGUE)}}}"  # 30 digits between doubt and noise
SURE = "sensors.landmarks={kind: bearing, rate: 100, noise: 0.01}"  # of its bearings, far too much
FAR_OFF = ("estimator={kind: bearing_survey, distance_std: 1.0e+9, std: 1.0e-9}", SURE, "period=0.01")
TURNED = ("controller=lqr", "reference={kind: line, acceleration: 1}", "robot.start=[0, 0, 0.3]")

CASES = [
    ("landmark on the axis", ISHIKAWA + "estimation-lyapunov-mended", AXIS, "estimator/singular", 1000),
    ("landmark on the axis", ISHIKAWA + "estimation-elo", AXIS, "estimator/singular", 1000),
    ("landmark on the axis", ISHIKAWA + "estimation-ekf", AXIS, "estimator/singular", 1000),
    (
        "landmark on the axis",
        ISHIKAWA + "estimation-ekf",
        (*AXIS, "estimator=bearing_survey"),
        "estimator/singular",
        1000,
    ),
    ("landmark on the axis", ISHIKAWA + "estimation-elo-bench", (*AXIS, LANDMARKS), "estimator/singular", 50),
    ("robot on a landmark", ISHIKAWA + "estimation-elo", ON_A, "sensors.landmarks/touching", 1),
    ("robot on a landmark", ISHIKAWA + "estimation-elo", AXIS, "estimator/held", 1),
    (
        "robot on a landmark",
        ISHIKAWA + "estimation-ekf",
        (*AXIS, "estimator=bearing_survey"),
        "estimator/held",
        1,
    ),
    (
        "robot on a landmark",
        ISHIKAWA + "estimation-elo-bench",
        (*ON_A, LANDMARKS),
        "sensors.eye/touching",
        1,
    ),
    ("robot on a landmark", BUI + "ekf", ("robot.start=[-10, 10, 0]",), "sensors.landmarks/touching", 1),
    (
        "robot on a landmark",
        BUI + "ekf-bench",
        ("robot.start=[-10, 10, 0]",),
        "sensors.landmarks/touching",
        1,
    ),
    ("zero speed", BUI + "closed-loop", TURNED, "controller/standing", 1),
    ("zero speed", BUI + "closed-loop-bench", (*TURNED, "estimator=odometry"), "controller/standing", 1),
    ("steering beyond its limit", BUI + "test2-type1", (), "controller/limited", 4),
    ("steering beyond its limit", BUI + "test2-type2-bench", (), "controller/limited", 43),
    ("steering beyond its limit", BUI + "closed-loop", (FACING_BACK,), "controller/limited", 1),
    ("all weights zero", LAGES + "single", EXACT, "estimator/unexplained", 5),
    ("all weights zero", LAGES + "single", EXACT, "estimator/recovered", 1),
    ("all weights zero", LAGES + "single-bench", EXACT, "estimator/unexplained", 5),
    ("covariance not positive", ISHIKAWA + "estimation-ekf", AXIS, "estimator/restarted", 1),
    (
        "covariance not positive",
        ISHIKAWA + "estimation-ekf-bench",
        (*AXIS, LANDMARKS),
        "estimator/restarted",
        1,
    ),
    ("covariance not positive", BUI + "ekf", (ROUNDED_OFF,), "estimator/restarted", 1),
    ("covariance not positive", ISHIKAWA + "estimation-ekf", FAR_OFF, "estimator/restarted", 1),
    ("NaN", ISHIKAWA + "estimation-elo", (nan_of("landmarks"),), "estimator/ignored", 2000),
    ("NaN", BUI + "ekf", (nan_of("landmarks"),), "estimator/ignored", 40),
    ("NaN", BUI + "closed-loop", (nan_of("pose"),), "estimator/ignored", 10),
    ("NaN", BUI + "closed-loop-bench", (nan_of("landmarks"),), "estimator/ignored", 40),
    ("NaN", LAGES + "single", (nan_of("gps"),), "estimator/ignored", 5),
    ("NaN", LAGES + "single-bench", (nan_of("gps"),), "estimator/ignored", 5),
    ("NaN", PLIEGO + "circle", (nan_of("capture"),), "estimator/ignored", 100),
    ("NaN", PLIEGO + "observer-so2-bench", (nan_of("capture"),), "estimator/ignored", 80),
    ("heading error beyond the law", BUI + "closed-loop", (FACING_BACK,), "controller/beyond", 20),
    ("heading error beyond the law", BUI + "closed-loop-bench", (FACING_BACK,), "controller/beyond", 200),
    (
        "heading error beyond the law",
        BUI + "closed-loop",
        (FACING_BACK, "controller=lqr"),
        "controller/beyond",
        1,
    ),
    (
        "heading error beyond the law",
        ISHIKAWA + "reverse",
        (
            f"robot.start=[3, 1, {pi / 2}]",
            "estimator=odometry",
            "sensors={}",
        ),
        "controller/beyond",
        1,
    ),
]


@pytest.mark.parametrize(
    ("scenario", "settings", "count", "least"),
    [case[1:] for case in CASES],
    ids=[f"{case[0]} in {case[1]}, {case[3]}" for case in CASES],
)
def test_it_goes_on_and_is_counted(scenario: str, settings: tuple[str, ...], count: str, least: int) -> None:
    run = ran(scenario, "duration=2", "criteria={}", *settings)
    part, name = count.split("/")
    assert (run.status, run.verdict["reason"]) == (0, "")
    for signal in ("truth", "estimate", "command"):
        assert np.isfinite(run.signals[signal]).all()
    assert run.verdict["counts"][part][name] >= least


def test_an_experiment_as_it_should_be_counts_nothing() -> None:
    for name in (ISHIKAWA + "estimation-ekf", BUI + "closed-loop", BUI + "ekf", PLIEGO + "observer-so2"):
        counts = ran(name, "duration=2", "criteria={}").verdict["counts"]
        assert not any(value for part in counts.values() for value in part.values()), (name, counts)


def test_at_standstill_the_front_wheel_turns_and_waits() -> None:
    run = ran(BUI + "closed-loop", "duration=1", "criteria={}", *TURNED)
    v, γ = run.signals["command"][0]
    assert (v, γ) == pytest.approx((0.0, -pi / 4)), "the line is to the right"
    np.testing.assert_allclose(run.signals["truth"][1], run.signals["truth"][0], atol=1e-12)


def test_the_report_page_tells_what_was_counted(tmp_path: Path) -> None:
    loaded = load(ISHIKAWA + "estimation-ekf", ["duration=2", "criteria={}", "record=signals", *AXIS])
    outcome = perform(loaded, RunFolder(tmp_path / "run"))
    write_report(tmp_path / "run")
    page = (tmp_path / "run" / "report.html").read_text()
    for name in ("singular", "restarted", "touching"):
        value = next(counts[name] for counts in outcome.verdict["counts"].values() if name in counts)
        assert value > 0
        assert f'<td>{name}</td><td class="number">{value:.4g}</td>' in page
