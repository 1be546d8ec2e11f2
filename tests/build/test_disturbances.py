"""Each disturbance shows through the whole bench: on the right signal, from its start, and nowhere before."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from hilbed.disturbances import DISTURBANCES
from tests.bench import ran
from tests.build.scenarios import small
from tests.build.test_bus_faults import KINDS

START = 0.5
Signals = Mapping[str, np.ndarray]


def after(signals: Signals, name: str) -> np.ndarray:
    """Returns a signal of the cycles or ticks from the disturbance's start on."""
    t = signals["tick/t" if name.startswith("tick/") else "t"]
    return np.asarray(signals[name][t > START + 1e-9])


def load_torque(calm: Signals, hit: Signals) -> None:
    assert set(after(hit, "tick/drive/left/load_torque")) == {2.0}
    assert not hit["tick/drive/right/load_torque"].any()
    dip = after(calm, "tick/drive/left/speed") - after(hit, "tick/drive/left/speed")
    assert dip.max() > 0.05
    assert after(hit, "drive/left/current")[-1] > after(calm, "drive/left/current")[-1] + 0.5


def slip_patch(calm: Signals, hit: Signals) -> None:
    slip = [np.abs(after(signals, "tick/drive/right/slip")).max() for signals in (calm, hit)]
    assert slip[1] > 0.05 > 10 * slip[0]


def wheel_radius(calm: Signals, hit: Signals) -> None:
    """The left wheel rolls farther than the odometer knows: the robot turns right."""
    turned = after(hit, "truth")[-1, 2] - after(calm, "truth")[-1, 2]
    told = after(hit, "odometry")[-1, 2] - after(calm, "odometry")[-1, 2]
    way = np.hypot(*(after(hit, "truth")[-1, :2] - after(hit, "truth")[0, :2]))
    assert turned == pytest.approx(-0.1 * way / 0.4, rel=0.15)
    assert abs(told) < 0.1 * abs(turned)


def push(calm: Signals, hit: Signals) -> None:
    moved = after(hit, "truth")[-1] - after(calm, "truth")[-1]
    assert moved[1] > 0.005, "towards where it is pushed"


def supply_sag(calm: Signals, hit: Signals) -> None:
    """Half the voltage takes twice the duty for the same speed."""
    ratio = after(hit, "tick/drive/left/duty")[100:] / after(calm, "tick/drive/left/duty")[100:]
    assert ratio.mean() == pytest.approx(2.0, rel=0.1)
    speeds = [after(signals, "tick/drive/left/speed")[100:] for signals in (calm, hit)]
    assert speeds[1] == pytest.approx(speeds[0], rel=0.05)


def spurious_azimuths(calm: Signals, hit: Signals) -> None:
    false = hit["azimuth/beacon"] < 0
    assert false.sum() >= 3
    assert hit["azimuth/t"][false].min() >= START
    assert np.isnan(hit["azimuth/true"][false]).all()
    assert not np.any(calm["azimuth/beacon"] < 0)


def camera_loss(calm: Signals, hit: Signals) -> None:
    """Frames at 0.5 and 0.6 s are lost, the one at the very end of the loss is not."""
    exposed = [set(np.round(signals["azimuth/t"], 3)) for signals in (calm, hit)]
    assert exposed[0] - exposed[1] == {0.5, 0.6}
    assert exposed[1] < exposed[0]


def command_noise(calm: Signals, hit: Signals) -> None:
    """The drives are asked for something else than the controller asked for: both wheels, for a turn."""
    assert np.array_equal(hit["command"], calm["command"])
    left, right = (
        after(hit, f"drive/{side}/speed_ref") - after(calm, f"drive/{side}/speed_ref")
        for side in ("left", "right")
    )
    assert left == pytest.approx(-right, abs=2e-4)  # what a target on the bus resolves
    assert np.abs(right).max() > 0.1
    assert after(hit, "truth")[-1, 2] != pytest.approx(after(calm, "truth")[-1, 2], abs=1e-3)


EFFECTS = {
    "load_torque": ("drive: left, size: 2", load_torque),
    "slip_patch": ("corner: [-9, -9], opposite: [9, 9], friction: 0.01", slip_patch),
    "wheel_radius": ("drive: left, size: 1.1", wheel_radius),
    "push": ("size: [0, 150], length: 0.2", push),
    "supply_sag": ("size: 12", supply_sag),
    "command_noise": ("size: [0, 0.2], hold: 0.1", command_noise),
    "spurious_azimuths": ("size: 3", spurious_azimuths),
    "camera_loss": ("length: 0.2", camera_loss),
}


OF_SENSORS = {"sensor_loss", "sensor_nan"}  # looked at in tests/sensors, on both plants


def test_every_kind_is_looked_at() -> None:
    assert set(EFFECTS) | KINDS | OF_SENSORS == set(DISTURBANCES)


@pytest.fixture(scope="module")
def calm(tmp_path_factory: pytest.TempPathFactory) -> Signals:
    return ran(small(tmp_path_factory.mktemp("calm")), "controller=open_loop").signals


@pytest.mark.parametrize("kind", EFFECTS)
def test_it_shows(tmp_path: Path, calm: Signals, kind: str) -> None:
    block, shows = EFFECTS[kind]
    setting = f"disturbances=[{{kind: {kind}, start: {START}, {block}}}]"
    hit = ran(small(tmp_path), "controller=open_loop", setting).signals
    until = round(START * 1000)
    for name, column in hit.items():
        if name.startswith("tick/"):
            assert np.array_equal(column[: until + 1], calm[name][: until + 1]), name
    shows(calm, hit)


@pytest.mark.parametrize(
    ("shape", "at", "expected"),
    [
        ("shape: ramp, rise: 0.4", (0.6, 0.7, 0.95), (0.5, 1.0, 2.0)),
        ("shape: impulse", (0.51, 0.519, 0.53), (2.0, 2.0, 0.0)),
    ],
)
def test_shapes_of_a_load(
    tmp_path: Path, shape: str, at: tuple[float, ...], expected: tuple[float, ...]
) -> None:
    setting = f"disturbances=[{{kind: load_torque, drive: right, start: {START}, size: 2, {shape}}}]"
    signals = ran(small(tmp_path), setting).signals
    load = np.interp(at, signals["tick/t"], signals["tick/drive/right/load_torque"])
    assert load == pytest.approx(expected, abs=0.02)
