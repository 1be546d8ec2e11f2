"""Runs with one fault each: the attribution names it, and its rerun is the run to the bit."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

from hilbed.attribution import Attribution, attribute
from hilbed.attribution.evidence import ASSOCIATION, LATENESS, START
from hilbed.attribution.wheels import ENCODER, MODEL, ODOMETRY, SLIP
from hilbed.record.folder import RunFolder
from hilbed.record.readings import Signals
from hilbed.runner import perform
from hilbed.scenario.load import Loaded, load

DEAD = (
    "duration=4",
    "estimator=odometry",
    "sensors={}",
    "controller=open_loop",
    "criteria={}",
    "record=signals",
)
QUIET = "disturbances=[]"
SLIPPERY = "disturbances=[{kind: slip_patch, corner: [-9, -9], opposite: [9, 9], friction: 0.02}]"
WORN = "disturbances=[{kind: wheel_radius, drive: left, size: 1.01}]"
STALE = "plant.encoder.latency=0.002"


@cache
def recorded(name: str, *settings: str) -> tuple[Loaded, Signals]:
    loaded = load(name, settings)
    with TemporaryDirectory() as place:
        assert perform(loaded, RunFolder(Path(place) / "run")).status in (0, 1)
        with np.load(Path(place) / "run" / "signals.npz") as archive:
            return loaded, dict(archive)


def found(name: str, *settings: str) -> Attribution:
    attribution = attribute(*recorded(name, *settings))
    assert attribution is not None
    return attribution


@pytest.mark.parametrize(
    ("name", "settings"),
    [
        ("demo", ("duration=6",)),
        ("demo", ("duration=6", "sensors.camera.identity=anonymous", "sensors.camera.spurious=0.3")),
        ("lages2017/single-bench", ("duration=2",)),
        ("pliego2023/circle-bench", ("duration=3",)),
        ("bui2022/ekf-bench", ("duration=3",)),
        ("bui2022/ekf", ()),
        ("ishikawa1994/estimation-ekf", ()),
    ],
)
def test_the_rerun_is_the_run(name: str, settings: tuple[str, ...]) -> None:
    attribution = found(name, *settings)
    assert attribution.rerun == attribution.recorded


@pytest.mark.parametrize(("fault", "source"), [(SLIPPERY, SLIP), (WORN, MODEL), (STALE, ENCODER)])
def test_of_dead_reckoning_with_one_fault_that_one_is_named(fault: str, source: str) -> None:
    settings = (fault,) if fault.startswith("disturbances") else (QUIET, fault)
    attribution = found("demo", *DEAD, *settings)
    shares = {share.source: share for share in attribution.shares}
    assert set(shares) == {SLIP, MODEL, ENCODER}
    most = max(shares, key=lambda name: shares[name].alone.position)
    assert most == source
    assert shares[source].without.position < 0.3 * attribution.recorded.position
    assert shares[source].alone.position == pytest.approx(attribution.recorded.position, rel=0.3)
    assert attribution.nothing.position < 1e-4


def test_of_an_ideal_robot_nothing_is_left_without_its_noise() -> None:
    attribution = found("bui2022/ekf")
    assert {share.source for share in attribution.shares} == {ODOMETRY, "range error", "azimuth error", START}
    assert attribution.nothing.position < 1e-9
    assert all(share.alone.position <= attribution.recorded.position for share in attribution.shares)


def test_late_readings_hurt_where_the_odometry_is_bad() -> None:
    late = ("duration=8", WORN.replace("1.01", "1.1"), "sensors.camera.latency=0.5")
    attribution, prompt = found("demo", *late), found("demo", *late[:-1], "sensors.camera.latency=0")
    shares = {share.source: share for share in attribution.shares}
    assert LATENESS not in {share.source for share in prompt.shares}
    assert shares[LATENESS].without.yaw < 0.6 * attribution.recorded.yaw


def test_false_azimuths_that_are_taken_for_beacons_are_association() -> None:
    fooled = ("duration=6", QUIET, "sensors.camera.spurious=1", "estimator.gate=100")
    attribution = found("demo", *fooled)
    shares = {share.source: share for share in attribution.shares}
    assert shares[ASSOCIATION].without.position < 0.3 * attribution.recorded.position
    assert max(shares, key=lambda name: shares[name].alone.position) == ASSOCIATION


def test_a_blind_robot_has_no_error_of_readings() -> None:
    attribution = found("demo", "duration=2", "sensors.camera.loss=1", "criteria={}")
    assert attribution.rerun == attribution.recorded
    assert {share.source for share in attribution.shares} == {SLIP, MODEL, ENCODER}


def test_without_truth_nothing_is_said() -> None:
    loaded, signals = recorded("bui2022/ekf")
    assert attribute(loaded, {**signals, "truth": np.full_like(signals["truth"], np.nan)}) is None
    old = {name: column for name, column in signals.items() if name != "odometry_step"}
    assert attribute(loaded, old) is None
