from __future__ import annotations

from math import atan2, inf, nan

import numpy as np
import pytest
from pydantic import ValidationError

from hilbed.angles import wrap
from hilbed.estimation.bearing_specs import (
    BearingKalmanSpec,
    BearingsSpec,
    LuenbergerSpec,
    LyapunovObserverSpec,
)
from hilbed.estimation.bearings import Bearings
from hilbed.plant.kinematics import exact
from hilbed.types import Array, Odometry, Pose, Reading

T = 10_000_000
START = Pose(1.0, 2.0, -0.5)
LANDMARKS = ((0.0, 0.0), (0.0, 1.0))
SPECS: list[BearingsSpec] = [
    LyapunovObserverSpec(epsilon_2=2.0e-4),
    BearingKalmanSpec(),
    BearingKalmanSpec(form="sampled"),
    LuenbergerSpec(),
]
EACH = pytest.mark.parametrize("spec", SPECS, ids=lambda spec: f"{spec.kind}-{getattr(spec, 'form', '')}")


def azimuth(t: int, pose: Pose, k: int, named: bool = True, delivered: int | None = None) -> Reading:
    x, y = LANDMARKS[k]
    value = wrap(atan2(y - pose.y, x - pose.x) - pose.yaw)
    return Reading("azimuth", t, delivered or t, (value,), (1e-3,), k if named else None)


class Drive:
    """A robot at 1 m/s on a wide curve."""

    def __init__(self, v: float = 1.0, w: float = 0.2) -> None:
        self.pose, self.t, self.v, self.w = START, 0, v, w

    def odometry(self) -> Odometry:
        moved = (self.v * 0.01, self.w * 0.01) if self.t else (0.0, 0.0)
        return Odometry(self.t, *moved, self.v, self.w)

    def move(self) -> None:
        self.pose, self.t = exact(self.pose, (self.v, self.w), 0.01), self.t + T

    def seen(self, named: bool = True) -> list[Reading]:
        return [azimuth(self.t, self.pose, k, named) for k in (0, 1)]


def error(drive: Drive, mean: Array) -> float:
    return max(np.hypot(*(mean - drive.pose)[:2]), abs(wrap(float(mean[2]) - drive.pose.yaw)))


@EACH
def test_a_camera_that_is_slow_and_late_will_do(spec: BearingsSpec) -> None:
    """Ten a second, 40 ms late, the landmarks by turns."""
    drive, estimator, coming = Drive(), Bearings(spec, START), list[Reading]()
    for k in range(300):
        if k % 5 == 0:
            reading = azimuth(drive.t, drive.pose, k // 5 % 2, True, drive.t + 4 * T)
            coming.append(reading)
        due = [r for r in coming if r.delivered <= drive.t]
        coming = coming[len(due) :]
        estimate = estimator.step(drive.t, drive.odometry(), due)
        left = error(drive, estimate.mean)
        drive.move()
    assert left < 0.02
    assert estimate.landmark_distance == pytest.approx(1.0, abs=0.01)
    assert estimator.ignored == 0


@EACH
def test_readings_before_their_odometry_wait_for_it(spec: BearingsSpec) -> None:
    """Odometry that comes a cycle late leaves the same belief, a cycle later."""
    prompt, behind, drive = Bearings(spec, START), Bearings(spec, START), Drive()
    odometry: list[Odometry] = []
    for _ in range(60):
        odometry.append(drive.odometry())
        a = prompt.step(drive.t, odometry[-1], drive.seen())
        b = behind.step(drive.t, odometry[max(len(odometry) - 2, 0)], drive.seen())
        drive.move()
    c = behind.step(drive.t - T, odometry[-1], [])
    np.testing.assert_allclose(a.mean, c.mean, atol=1e-12)
    assert error(drive, b.mean) < 5.0


@EACH
def test_nameless_readings_go_to_the_landmark_that_expects_them(spec: BearingsSpec) -> None:
    named, nameless, drive = Bearings(spec, START), Bearings(spec, START), Drive()
    for k in range(150):
        a = named.step(drive.t, drive.odometry(), drive.seen())
        b = nameless.step(drive.t, drive.odometry(), drive.seen(named=k == 0))
        np.testing.assert_allclose(a.mean, b.mean, atol=1e-12)
        drive.move()
    assert nameless.ignored == 0


@EACH
def test_a_gap_in_the_readings_is_bridged_by_odometry(spec: BearingsSpec) -> None:
    estimator, drive = Bearings(spec.model_copy(update={"memory": 0.2}), START), Drive()
    for k in range(400):
        readings = [] if 150 <= k < 250 else drive.seen()
        left = error(drive, estimator.step(drive.t, drive.odometry(), readings).mean)
        if k == 249:
            assert left < 0.05
        drive.move()
    assert left < 1e-2


def test_until_both_are_seen_the_start_is_carried_by_odometry() -> None:
    estimator, drive = Bearings(LuenbergerSpec(), START), Drive()
    for _ in range(50):
        only_a = [azimuth(drive.t, drive.pose, 0)]
        nameless = [azimuth(drive.t, drive.pose, 1, named=False)]
        estimate = estimator.step(drive.t, drive.odometry(), only_a + nameless)
        assert error(drive, estimate.mean) < 1e-3
        assert np.isnan(estimate.landmark_distance)
        assert np.isnan(estimate.covariance).all()
        drive.move()
    assert estimator.ignored == 50


@EACH
def test_what_cannot_be_used_is_counted_and_changes_nothing(spec: BearingsSpec) -> None:
    clean, dirty, drive = Bearings(spec, START), Bearings(spec, START), Drive()
    bad = [
        Reading("azimuth", 20 * T, 20 * T, (nan,), (1e-3,), 0),
        Reading("azimuth", 20 * T, 20 * T, (inf,), (1e-3,), 1),
        Reading("azimuth", 20 * T, 20 * T, (0.1,), (1e-3,), 7),
        Reading("range", 20 * T, 20 * T, (2.0,), (1e-3,), 0),
        Reading("azimuth", 5 * T, 20 * T, (0.4,), (1e-3,), 0),
        Reading("azimuth", 10**15, 20 * T, (0.4,), (1e-3,), 0),
    ]
    for k in range(40):
        a = clean.step(drive.t, drive.odometry(), drive.seen())
        b = dirty.step(drive.t, drive.odometry(), drive.seen() + (bad if k == 20 else []))
        np.testing.assert_array_equal(a.mean, b.mean)
        drive.move()
    assert dirty.ignored == len(bad)
    broken = dirty.step(drive.t, Odometry(drive.t, nan, inf, nan, nan), drive.seen())
    assert np.isfinite(broken.mean).all()
    assert dirty.ignored == len(bad) + 1


@EACH
def test_driving_over_a_landmark_leaves_finite_numbers(spec: BearingsSpec) -> None:
    """Straight at A and over it: its bearing is singular on the way and jumps by half a turn."""
    estimator, drive = Bearings(spec, START), Drive(1.0, 0.0)
    drive.pose = Pose(-1.0, 0.0, 0.0)
    for _ in range(200):
        estimate = estimator.step(drive.t, drive.odometry(), drive.seen())
        assert np.isfinite(estimate.mean).all()
        drive.move()


@EACH
def test_a_standing_robot_keeps_its_belief(spec: BearingsSpec) -> None:
    estimator, drive = Bearings(spec, START), Drive(0.0, 0.0)
    first = estimator.step(0, drive.odometry(), drive.seen())
    for _ in range(50):
        drive.move()
        estimate = estimator.step(drive.t, drive.odometry(), drive.seen())
    if spec.kind == "bearing_kalman" and spec.form == "sampled":  # it averages the bearing, and learns φ only
        assert estimate.mean == pytest.approx(first.mean, abs=0.3)
    else:
        assert estimate.mean == pytest.approx(first.mean, abs=1e-9)


@EACH
def test_the_same_input_gives_the_same_bits(spec: BearingsSpec) -> None:
    def means() -> Array:
        estimator, drive, rows = Bearings(spec, START), Drive(), []
        for _ in range(80):
            rows.append(estimator.step(drive.t, drive.odometry(), drive.seen()[::-1]).mean)
            drive.move()
        return np.array(rows)

    np.testing.assert_array_equal(means(), means())


@pytest.mark.parametrize(
    ("kind", "bad"),
    [
        (LyapunovObserverSpec, {"epsilon_2": 1e-4}),
        (LyapunovObserverSpec, {"distances": (0.0, 1.0)}),
        (BearingKalmanSpec, {"R": 0.0}),
        (BearingKalmanSpec, {"form": "both"}),
        (LuenbergerSpec, {"floor": 0.0}),
        (LuenbergerSpec, {"poles": (-8, -8)}),
    ],
)
def test_bad_settings_are_refused(kind: type[BearingsSpec], bad: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        kind.model_validate(bad)
