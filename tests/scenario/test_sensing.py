"""Sensors, estimators and disturbances that cannot go together are refused, with the reason."""

from __future__ import annotations

import pytest

from hilbed.scenario.load import load
from hilbed.types import ScenarioError

PLIEGO, LAGES, SLIMANE = "pliego2023/circle-bench", "lages2017/single-bench", "slimane2014/tracking-circle"


@pytest.mark.parametrize(
    ("scenario", "setting", "message"),
    [
        (
            PLIEGO,
            "sensors={eye: {kind: bearing}}",
            "attitude needs readings of position, but eye gives azimuth",
        ),
        (
            PLIEGO,
            "sensors.capture.yaw_noise=0.01",
            "attitude needs readings of position, but capture gives pose",
        ),
        (
            LAGES,
            "sensors={scanner: {kind: range_bearing}}",
            "particles needs readings of position or pose, but scanner gives range; scanner gives azimuth",
        ),
        (LAGES, "sensors={}", "particles needs readings and there are no sensors"),
        (
            SLIMANE,
            "sensors={gps: {kind: position}}",
            "ekf needs readings of azimuth or range, but gps gives position",
        ),
        (
            SLIMANE,
            "sensors.scanner={kind: range_bearing, mount: [0.2, 0.0]}",
            "camera and scanner have different mounts; ekf knows one for all",
        ),
        (SLIMANE, "sensors.camera={kind: sonar}", "unknown kind 'sonar'; known: "),
        (
            PLIEGO,
            "disturbances=[{kind: sensor_loss, sensor: captur}]",
            "disturbances.0.sensor: there is no sensor 'captur'; did you mean 'capture'?",
        ),
        (
            SLIMANE,
            "disturbances=[{kind: sensor_nan, sensor: camera}]",
            "disturbances.0.sensor: camera is a camera; camera_loss and spurious_azimuths are for those",
        ),
        (
            PLIEGO,
            "disturbances=[{kind: spurious_azimuths, size: 1}]",
            "disturbances.0: spurious_azimuths needs a camera among the sensors",
        ),
        (
            "pliego2023/circle",
            "disturbances=[{kind: push, size: [1, 1]}]",
            "disturbances.0: push cannot befall an ideal robot; plant: bullet can",
        ),
    ],
)
def test_it_is_refused_with_the_reason(scenario: str, setting: str, message: str) -> None:
    with pytest.raises(ScenarioError) as refusal:
        load(scenario, [setting])
    assert message in str(refusal.value)


def test_sensors_of_landmarks_need_some() -> None:
    with pytest.raises(ScenarioError, match="eye sees nothing without beacons, and ekf needs readings"):
        load(SLIMANE, ["sensors={eye: {kind: bearing}}", "plant.beacons=[]"])


@pytest.mark.parametrize(
    ("scenario", "setting"),
    [
        (SLIMANE, "sensors={scanner: {kind: range_bearing}}"),
        (SLIMANE, "sensors.gps={kind: position}"),
        (SLIMANE, "sensors={camera: camera}"),
        (LAGES, "sensors.gps.yaw_noise=null"),
        (PLIEGO, "sensors.capture.front=0.1"),
        ("pliego2023/circle", "disturbances=[{kind: sensor_nan, sensor: capture}]"),
    ],
)
def test_what_can_go_together_is_let_through(scenario: str, setting: str) -> None:
    load(scenario, [setting])
