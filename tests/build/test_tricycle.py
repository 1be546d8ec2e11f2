"""The tricycle on the whole bench: told speed and steering angle, it drives the circle of its geometry."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from math import cos, hypot, pi, sin, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from hilbed.angles import wrap
from hilbed.build import Bench, build
from hilbed.cost import Cost
from hilbed.poses import moved
from hilbed.record.notes import Notes
from hilbed.scenario.load import load
from hilbed.types import Command, Odometry, Pose, ScenarioError
from tests.firmware.test_course import trapezoid

PERIOD = 10_000_000
TYPES = ({"drive": "front"}, {"drive": "rear"}, {"drive": "rear", "differential": False})


def scenario(folder: Path, robot: dict[str, Any], **blocks: Any) -> str:
    content = {
        "duration": 10,
        "robot": {"kind": "tricycle", "start": [0.0, 0.0, 0.0], **robot},
        "plant": "bullet",
        "estimator": "odometry",
        "controller": "open_loop",
        "reference": {"kind": "line"},
        **blocks,
    }
    path = folder / "tricycle.yaml"
    path.write_text(yaml.safe_dump(content))
    return str(path)


@contextmanager
def bench(folder: Path, robot: dict[str, Any], **blocks: Any) -> Iterator[Bench]:
    made = build(load(scenario(folder, robot, **blocks)), Notes(), Cost())
    try:
        made.boot(lambda: None)
        yield made
    finally:
        made.close()


class Drive:
    """Tells a bench commands; `poses` and `odometry` a cycle, `reckoned` where odometry alone leads."""

    def __init__(self, made: Bench) -> None:
        self._bench = made
        self._t = 0
        self.poses: list[Pose] = []
        self.odometry: list[Odometry] = []
        self.reckoned = Pose(0.0, 0.0, 0.0)

    def go(self, command: Command, seconds: float) -> None:
        rig = self._bench.rig
        for _ in range(round(seconds * 100)):
            odometry = rig.base.read(self._t)
            rig.base.write(self._t, command)
            rig.plant.advance(self._t, self._t + PERIOD)
            self._t += PERIOD
            self.poses.append(rig.plant.truth().pose)
            self.odometry.append(odometry)
            self.reckoned = moved(self.reckoned, odometry.distance, odometry.turn)


def arc(poses: list[Pose]) -> tuple[float, float]:
    """Returns way along its heading and turn of a run of poses: their quotient is the radius."""
    way = turn = 0.0
    for a, b in pairwise(poses):
        middle = a.yaw + 0.5 * wrap(b.yaw - a.yaw)
        way += (b.x - a.x) * cos(middle) + (b.y - a.y) * np.sin(middle)
        turn += wrap(b.yaw - a.yaw)
    return way, turn


@pytest.mark.parametrize("robot", TYPES[:2], ids=["front", "rear"])
@pytest.mark.parametrize(("v", "γ"), [(0.5, 0.4), (0.5, -0.6), (-0.4, 0.3), (-0.4, -0.5)])
def test_it_drives_the_circle_of_its_geometry(
    tmp_path: Path, robot: dict[str, Any], v: float, γ: float
) -> None:
    with bench(tmp_path, {"wheelbase": 0.8, **robot}) as made:
        drive = Drive(made)
        drive.go(Command(v, γ), 4.0)
        way, turn = arc(drive.poses[100:])
        assert way / turn == pytest.approx(0.8 / tan(γ), rel=3e-3)
        axle = v * cos(γ) if robot["drive"] == "front" else v
        assert way / 2.99 == pytest.approx(axle, rel=3e-3)
        seen = drive.odometry[-1]
        assert (seen.v, seen.w) == pytest.approx((axle, axle * tan(γ) / 0.8), rel=0.02)
        assert seen.drives["steering"].angle_measured == pytest.approx(γ, abs=1e-3)
        # Odometry is two periods behind the truth.
        assert hypot(*(np.subtract(drive.reckoned, drive.poses[-3])[:2])) < 0.01


def test_rear_wheels_that_are_coupled_slip_in_a_curve(tmp_path: Path) -> None:
    slips = []
    for robot in TYPES[1:]:
        with bench(tmp_path, robot) as made:
            Drive(made).go(Command(0.5, 0.5), 3.0)
            log = made.ticks(1500)
            slips.append(max(abs(log[f"tick/drive/{side}/slip"]).mean() for side in ("left", "right")))
    assert slips[0] < 1e-3
    # The outer wheel carries more and rolls; the robot is as much slower as the inner one is too fast.
    ε = 0.3 * tan(0.5)
    assert slips[1] == pytest.approx(0.5 * 2 * ε / (1 + ε), rel=0.01)


def test_the_steering_axis_keeps_to_its_limits(tmp_path: Path) -> None:
    with bench(tmp_path, {"drive": "front", "max_steering": 0.5, "max_steering_rate": 1.0}) as made:
        drive = Drive(made)
        drive.go(Command(0.2, 0.9), 1.0)
        angle = made.ticks(0)["tick/drive/steering/angle"]
        assert angle[-1] == pytest.approx(0.5, abs=2e-3)  # 607D, whatever is asked for
        assert angle.max() < 0.51
        steps = np.diff(angle[100:500]) * 1e3
        assert steps.mean() == pytest.approx(1.0, abs=0.02)
        assert made.events() == []


def test_a_steering_axis_that_is_held_fast_stops_with_a_fault(tmp_path: Path) -> None:
    jam = {"kind": "load_torque", "drive": "steering", "start": 0.0, "size": 40.0}
    with bench(tmp_path, {"drive": "front"}, disturbances=[jam]) as made:
        Drive(made).go(Command(0.0, 0.5), 2.0)
        assert any("steering" in event and "8611" in event for event in made.events())


def test_in_profile_position_mode_it_ramps_to_its_set_points(tmp_path: Path) -> None:
    """A jump of the command is one set-point: the axis takes the trapezoid of 6081, 6083 and 6084."""
    nodes = {"steering": {"mode": "pp", "gains": {"acceleration": 42_000, "deceleration": 42_000}}}
    with bench(tmp_path, {"drive": "front", "max_steering_rate": 1.0}, nodes=nodes) as made:
        drive = Drive(made)
        drive.go(Command(0.0, 0.7), 1.5)
        angle = made.ticks(0)["tick/drive/steering/angle"]
        expected = [trapezoid(0.7, 1.0, 4.0, 4.0, 1e-3 * k) for k in range(1400)]
        # The order is on its way for about a millisecond, and the axis some more behind its demand.
        late = min(range(30), key=lambda k: abs(angle[k : k + 1400] - expected).max())
        assert abs(angle[late : late + 1400] - expected).max() < 0.02
        assert 0 < late < 20
        assert drive.odometry[-1].drives["steering"].angle_measured == pytest.approx(0.7, abs=2e-3)
        drive.go(Command(0.0, -0.3), 1.5)
        assert made.ticks(0)["tick/drive/steering/angle"][-1] == pytest.approx(-0.3, abs=2e-3)
        assert made.events() == []


@pytest.mark.parametrize(("mode", "lag"), [("csp", 0.02), ("pp", 0.07)])
def test_the_angle_follows_its_reference_in_either_mode(tmp_path: Path, mode: str, lag: float) -> None:
    """A sine: CSP is as late as a synchronous order and the drive are; the handshake takes cycles more."""
    with bench(tmp_path, {"drive": "front"}, nodes={"steering": {"mode": mode}}) as made:
        drive = Drive(made)
        for k in range(200):
            drive.go(Command(0.3, 0.5 * sin(pi * 0.01 * k)), 0.01)
        log = made.ticks(0)
        t, angle = log["tick/t"][500:], log["tick/drive/steering/angle"][500:]
        found = np.polyfit(0.5 * pi * np.cos(pi * t), angle - 0.5 * np.sin(pi * t), 1)[0]
        assert -found == pytest.approx(lag, abs=0.01)


def test_in_place_it_steers_and_stays(tmp_path: Path) -> None:
    with bench(tmp_path, {"drive": "rear"}) as made:
        drive = Drive(made)
        drive.go(Command(0.0, 0.7), 1.0)
        assert made.ticks(0)["tick/drive/steering/angle"][-1] == pytest.approx(0.7, abs=2e-3)
        assert drive.poses[-1] == pytest.approx((0.0, 0.0, 0.0), abs=2e-3)
        drive.go(Command(0.0, -pi / 4), 1.0)
        assert made.ticks(0)["tick/drive/steering/angle"][-1] == pytest.approx(-pi / 4, abs=2e-3)


def test_a_slippery_patch_lies_under_the_wheels_that_are_on_it(tmp_path: Path) -> None:
    """Only the front wheel is on it, which turns on the spot while the rest of the robot stands."""
    patch = {"kind": "slip_patch", "corner": [0.8, -0.2], "opposite": [9.0, 0.2], "friction": 0.0}
    with bench(tmp_path, {"drive": "front"}, disturbances=[patch]) as made:
        drive = Drive(made)
        drive.go(Command(0.5, 0.0), 2.0)
        assert drive.poses[-1].x < 0.05
        assert made.ticks(0)["tick/drive/traction/slip"][-1] == pytest.approx(0.5, rel=0.05)


@pytest.mark.parametrize(
    ("nodes", "message"),
    [
        ({"steering": {"table": "hilbed402"}}, "steering is told a position"),
        ({"traction": {"table": "hilbed402-csp"}}, "traction is told a speed"),
        ({"left": {}}, "the robot has no drive 'left'"),
    ],
)
def test_drives_that_do_not_suit_are_refused(tmp_path: Path, nodes: dict[str, Any], message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        load(scenario(tmp_path, {"drive": "front"}, nodes=nodes))
