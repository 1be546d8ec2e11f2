from __future__ import annotations

from math import atan, exp, inf, nan, pi, tan

import numpy as np
import pytest
from pydantic import ValidationError

from hilbed.angles import wrap
from hilbed.estimation.attitude_estimator import Attitude
from hilbed.estimation.attitude_spec import AttitudeSpec
from hilbed.plant.kinematics import exact
from hilbed.types import Estimate, Odometry, Pose, Reading

T = 10_000_000  # 100 Hz
START = Pose(0.5, -0.2, 0.4)
FORMS = pytest.mark.parametrize("form", ["so2", "s1", "global"])


def spec(form: str, error: float = 0.0, **settings: float) -> AttitudeSpec:
    return AttitudeSpec.model_validate({"form": form, "heading_error": error, **settings})


def position(t: int, pose: Pose, delivered: int | None = None) -> Reading:
    return Reading("position", t, delivered or t, (pose.x, pose.y), (1e-3, 1e-3))


class Drive:
    """A robot at 0.3 m/s on a circle, its odometry and its positions."""

    def __init__(self, v: float = 0.3, w: float = 0.5) -> None:
        self.pose, self.t, self.v, self.w = START, 0, v, w

    def odometry(self) -> Odometry:
        return Odometry(
            self.t, self.v * 0.01 if self.t else 0.0, self.w * 0.01 if self.t else 0.0, self.v, self.w
        )

    def move(self) -> None:
        self.pose, self.t = exact(self.pose, (self.v, self.w), 0.01), self.t + T


def heading_error(drive: Drive, estimate: Estimate) -> float:
    return wrap(drive.pose.yaw - float(estimate.mean[2]))


@pytest.mark.parametrize("form", ["so2", "s1"])
@pytest.mark.parametrize("e0", [2.5, -1.0, 3.1])
@pytest.mark.parametrize("v", [0.3, -0.3])
def test_the_error_law_holds_over_a_run(form: str, e0: float, v: float) -> None:
    drive, estimator = Drive(v), Attitude(spec(form, e0), START)
    for k in range(600):
        estimate = estimator.step(drive.t, drive.odometry(), [position(drive.t, drive.pose)])
        expected = 2 * atan(tan(e0 / 2) * exp(-5.0 * 0.09 * k * 0.01))
        assert heading_error(drive, estimate) == pytest.approx(expected, abs=1e-9)
        assert estimate.mean[:2] == pytest.approx(drive.pose[:2])
        drive.move()


@FORMS
def test_between_positions_odometry_carries_the_pose(form: str) -> None:
    """Five a second, each 70 ms late: in step once the heading has settled."""
    drive, estimator = Drive(), Attitude(spec(form, 2.5, gain=20.0), START)
    late: list[Reading] = []
    for k in range(1200):
        if k % 20 == 0:
            late.append(position(drive.t, drive.pose, drive.t + 7 * T))
        due = [r for r in late if r.delivered <= drive.t]
        late = late[len(due) :]
        estimate = estimator.step(drive.t, drive.odometry(), due)
        drive.move()
    drive.t -= T
    assert estimator.ignored == 0
    back = exact(drive.pose, (-drive.v, -drive.w), 0.01)
    assert estimate.mean[:2] == pytest.approx(back[:2], abs=1e-5)
    assert wrap(float(estimate.mean[2]) - back.yaw) == pytest.approx(0.0, abs=1e-4)


@FORMS
def test_a_gap_in_the_positions_is_bridged(form: str) -> None:
    drive, estimator = Drive(), Attitude(spec(form, 2.5, gain=20.0, memory=0.5), START)
    for k in range(1500):
        readings = [] if 300 <= k < 600 else [position(drive.t, drive.pose)]
        estimate = estimator.step(drive.t, drive.odometry(), readings)
        error = heading_error(drive, estimate)
        drive.move()
    assert error == pytest.approx(0.0, abs=1e-6)
    assert estimator.ignored == 0


@FORMS
def test_noise_of_a_motion_capture_is_averaged_out(form: str) -> None:
    drive, estimator, rng = Drive(), Attitude(spec(form, 1.0), START), np.random.default_rng(2)
    errors = []
    for _ in range(4000):
        x, y = rng.normal(drive.pose[:2], 1e-3).tolist()
        reading = position(drive.t, Pose(x, y, 0.0))
        errors.append(heading_error(drive, estimator.step(drive.t, drive.odometry(), [reading])))
        drive.move()
    assert np.std(errors[2000:]) < 0.01
    assert abs(np.mean(errors[2000:])) < 0.01


@FORMS
def test_what_cannot_be_used_is_counted_and_changes_nothing(form: str) -> None:
    clean, dirty = (Attitude(spec(form, 1.0), START) for _ in range(2))
    drive = Drive()
    bad = [
        Reading("position", T, T, (nan, 0.0), (1.0, 1.0)),
        Reading("azimuth", T, T, (0.1,), (1.0,), 0),
        Reading("position", -(10**12), T, (0.0, 0.0), (1.0, 1.0)),
        Reading("position", 10**15, T, (0.0, 0.0), (1.0, 1.0)),
    ]
    for k in range(50):
        good = position(drive.t, drive.pose)
        a = clean.step(drive.t, drive.odometry(), [good])
        b = dirty.step(drive.t, drive.odometry(), [good, good, *bad] if k == 20 else [good])
        np.testing.assert_array_equal(a.mean, b.mean)
        drive.move()
    assert dirty.ignored == len(bad) + 1
    broken = dirty.step(drive.t, Odometry(drive.t, inf, nan, nan, nan), [])
    assert np.isfinite(broken.mean).all()
    assert dirty.ignored == len(bad) + 2


def test_a_global_estimate_through_the_middle_still_has_a_heading() -> None:
    """From half a turn off Θ̄ passes through zero, where it points nowhere."""
    drive, estimator = Drive(0.3, 0.0), Attitude(spec("global", pi), START)
    for _ in range(600):
        estimate = estimator.step(drive.t, drive.odometry(), [position(drive.t, drive.pose)])
        assert np.isfinite(estimate.mean).all()
        error = heading_error(drive, estimate)
        drive.move()
    assert error == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("bad", [{"form": "so3"}, {"gain": 0.0}, {"heading_error": 4.0}, {"alpha": 1.0}])
def test_bad_settings_are_refused(bad: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        AttitudeSpec.model_validate(bad)


def front(t: int, pose: Pose) -> Reading:
    z = exact(pose, (0.1, 0.0), 1.0)
    return Reading("front", t, t, (z.x, z.y), (1e-3, 1e-3))


@FORMS
@pytest.mark.parametrize("swapped", [False, True])
def test_a_marker_ahead_is_carried_by_the_turn_whatever_the_heading_is_believed(
    form: str, swapped: bool
) -> None:
    """Ten a second, 50 ms late, first guess 2.5 rad off; as far as the axle is right, so is the marker."""
    drive, estimator = Drive(), Attitude(spec(form, 2.5), START)
    seen: dict[int, list[Reading]] = {}
    for k in range(300):
        if k % 10 == 0:
            pair = [position(drive.t, drive.pose), front(drive.t, drive.pose)]
            seen[k + 5] = pair[::-1] if swapped else pair
        estimate = estimator.step(drive.t, drive.odometry(), seen.pop(k, []))
        if k >= 5:
            assert estimate.front is not None
            z = exact(drive.pose, (0.1, 0.0), 1.0)
            lever = np.array(estimate.front) - estimate.mean[:2]
            np.testing.assert_allclose(lever, (z.x - drive.pose.x, z.y - drive.pose.y), atol=1e-9)
        else:
            assert estimate.front is None
        drive.move()
    assert estimator.ignored == 0


def test_a_marker_without_its_position_or_without_a_number_is_ignored() -> None:
    drive, estimator = Drive(), Attitude(spec("so2"), START)
    broken = front(0, START)._replace(value=(nan, 0.0))
    estimate = estimator.step(0, drive.odometry(), [front(0, START), broken])
    assert (estimate.front, estimator.counts()) == (None, {"ignored": 2})
