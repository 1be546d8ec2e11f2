"""The steering axis of a scenario: a drive train of its own, where its home is, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from hilbed.build import Bench
from hilbed.scenario.load import load
from hilbed.types import BusError, Command, ScenarioError
from tests.build.test_tricycle import Drive, bench, scenario

TYPES = pytest.mark.parametrize("robot", [{"drive": "front"}, {"drive": "rear"}], ids=["front", "rear"])


def plant(**steering: Any) -> dict[str, Any]:
    return {"kind": "bullet", "steering": steering}


def angle(made: Bench) -> Any:
    return made.ticks(0)["tick/drive/steering/angle"]


@TYPES
@pytest.mark.parametrize(("method", "start"), [(19, 0.3), (19, -0.2), (20, 0.3), (20, -0.2)])
def test_it_finds_its_switch_before_the_run(
    tmp_path: Path, robot: dict[str, Any], method: int, start: float
) -> None:
    nodes = {"steering": {"homing": method}}
    with bench(tmp_path, robot, plant=plant(start=start, switch=0.05), nodes=nodes) as made:
        assert made.rig.plant.truth().pose == pytest.approx((0.0, 0.0, 0.0), abs=1e-4)
        assert angle(made)[0] == pytest.approx(0.05, abs=5e-4)
        drive = Drive(made)
        drive.go(Command(0.0, 0.2), 1.0)
        assert len(angle(made)) == 1001  # what was before t = 0 is not in the log
        assert angle(made)[-1] == pytest.approx(0.2, abs=2e-3)
        measured = drive.odometry[-1].drives["steering"].angle_measured
        assert measured == pytest.approx(angle(made)[-1], abs=2e-4)
        assert made.events() == []


def test_homed_where_it_stands_an_axis_that_stands_askew_stays_so(tmp_path: Path) -> None:
    with bench(tmp_path, {"drive": "front"}, plant=plant(start=0.1)) as made:
        drive = Drive(made)
        drive.go(Command(0.3, 0.0), 3.0)
        assert drive.odometry[-1].drives["steering"].angle_measured == pytest.approx(0.0, abs=1e-3)
        assert angle(made)[-1] == pytest.approx(0.1, abs=1e-3)
        assert drive.poses[-1].yaw > 0.05  # and the robot drives a curve that odometry knows nothing of
        assert drive.reckoned.yaw == pytest.approx(0.0, abs=1e-3)


def test_a_switch_that_is_not_found_ends_the_boot(tmp_path: Path) -> None:
    """The axis is jammed: it times out, is a fault, and the bench says why."""
    nodes = {"steering": {"homing": 19, "gains": {"homing_timeout": 500}}}
    jam = plant(start=-0.3, switch=0.1, motor={**MOTOR, "coulomb": 10.0})
    with (
        pytest.raises(
            BusError, match=r"steering \(node 2\): has not found its home, error code 0x8600: homing"
        ),
        bench(tmp_path, {"drive": "front"}, plant=jam, nodes=nodes),
    ):
        pass


MOTOR = {
    "resistance": 1.2,
    "inductance": 0.5e-3,
    "back_emf": 0.05,
    "torque_constant": 0.05,
    "rotor_inertia": 5e-6,
    "nominal_current": 2.0,
    "max_current": 6.0,
    "source": "a test's own",
}


def test_it_has_a_motor_gear_and_encoder_of_its_own(tmp_path: Path) -> None:
    own = plant(motor=MOTOR, gear={"ratio": 60.0}, encoder={"resolution": 30_000})
    with bench(tmp_path, {"drive": "rear"}, plant=own) as made:
        settings = {node.name: node.settings for node in made.nodes}
        assert settings["steering"]["counts_per_turn"] == 30_000
        assert settings["steering"]["back_emf"] == pytest.approx(3.0)
        assert settings["steering"]["resistance"] == 1.2
        assert settings["left"]["counts_per_turn"] == 66_000
        assert settings["left"]["resistance"] == 0.583
        drive = Drive(made)
        drive.go(Command(0.0, 0.5), 1.0)
        assert angle(made)[-1] == pytest.approx(0.5, abs=3e-3)
        assert drive.odometry[-1].drives["steering"].angle_measured == pytest.approx(0.5, abs=3e-3)


@pytest.mark.parametrize(("rotor", "ratio"), [(79.2e-7, 33.0), (79.2e-7, 66.0), (1e-6, 33.0)])
def test_what_turns_with_the_axis_is_its_own(tmp_path: Path, rotor: float, ratio: float) -> None:
    """What one tick changes tells J: fork and wheel about the vertical, and the rotor behind its gear."""
    load_torque = {"kind": "load_torque", "drive": "steering", "start": 0.1, "size": -5.0, "length": 0.001}
    own = plant(motor={**MOTOR, "rotor_inertia": rotor}, gear={"ratio": ratio})
    with bench(tmp_path, {"drive": "rear"}, plant=own, disturbances=[load_torque]) as made:
        Drive(made).go(Command(0.0, 0.0), 0.2)
        log = made.ticks(0)
    speed, torque = log["tick/drive/steering/speed"], log["tick/drive/steering/torque"][101] + 5.0
    assert torque * 1e-3 / (speed[101] - speed[100]) == pytest.approx(0.004567 + rotor * ratio**2, rel=1e-3)


def test_a_load_on_the_axis_is_held(tmp_path: Path) -> None:
    torque = {"kind": "load_torque", "drive": "steering", "start": 0.2, "size": 3.0}
    with bench(tmp_path, {"drive": "front"}, disturbances=[torque]) as made:
        Drive(made).go(Command(0.0, 0.3), 1.5)
        log = made.ticks(0)
        assert log["tick/drive/steering/load_torque"][-1] == 3.0
        assert log["tick/drive/steering/angle"][-1] == pytest.approx(0.3, abs=5e-3)
        assert log["tick/drive/steering/current"][-1] > 2.0
        assert made.events() == []


@pytest.mark.parametrize(
    ("robot", "blocks", "message"),
    [
        ({"kind": "diffdrive"}, {"plant": plant()}, "plant.steering: the robot diffdrive has no steering"),
        ({}, {"plant": plant(start=1.0)}, r"plant.steering.start: 1 rad, the axis turns ±0.785"),
        ({}, {"plant": plant(switch=-1.0)}, r"plant.steering.switch: -1 rad, the axis turns ±0.785"),
        (
            {},
            {"nodes": {"steering": {"homing": 19}}},
            "method 19 looks for a home switch; plant.steering.switch",
        ),
        ({}, {"plant": plant(switch=0.0), "nodes": {"steering": {"homing": 17}}}, "looks for another switch"),
        ({}, {"nodes": {"steering": {"homing": 24}}}, "nodes.steering.homing"),
        ({}, {"nodes": {"left": {"homing": 19}}}, "hilbed402 has no setting 'homing'"),
        ({}, {"nodes": {"steering": {"mode": "pv"}}}, "hilbed402-csp has no mode 'pv'"),
        ({}, {"disturbances": [{"kind": "wheel_radius", "drive": "steering", "size": 1.1}]}, "does not roll"),
        ({}, {"criteria": {"step_overshoot": {"drive": "steering", "max": 1}}}, "is told an angle"),
        (
            {},
            {"criteria": {"dip": {"metric": "load_dip", "drive": "steering", "max": 1}}},
            "is told an angle",
        ),
    ],
)
def test_what_is_refused(tmp_path: Path, robot: dict[str, Any], blocks: dict[str, Any], message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        load(scenario(tmp_path, robot, **blocks))
