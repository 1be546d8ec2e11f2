from __future__ import annotations

from math import atan2, pi

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from hilbed.angles import wrap
from hilbed.scene import BeaconSpec
from hilbed.sensors.camera import CameraSpec
from hilbed.sensors.pan import fold
from hilbed.types import Pose, ScenarioError
from tests.sensors.cameras import BEACONS, Bench


def pans(pan: dict[str, object], frames: int, beacons: tuple[BeaconSpec, ...] = ()) -> list[float]:
    bench = Bench({"pan": pan}, beacons)
    bench.expose(frames)
    return bench.pans


def test_fixed() -> None:
    assert pans({"kind": "fixed", "angle": 0.3}, 3) == [0.3, 0.3, 0.3]


def test_scanning_goes_round_at_its_rate() -> None:
    expected = [wrap(1.0 - 2.0 * k / 10) for k in range(60)]
    assert pans({"kind": "scanning", "angle": 1.0, "rate": -2.0}, 60) == pytest.approx(expected)


def test_scanning_between_limits_turns_back() -> None:
    angles = pans({"kind": "scanning", "rate": 1.0, "limits": [-0.2, 0.3]}, 11)
    assert angles == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.2, 0.1, 0.0, -0.1, -0.2, -0.1, 0.0], abs=1e-12)


@given(st.floats(-100, 100), st.floats(-3, 3), st.floats(0.01, 6))
def test_fold_stays_inside_and_keeps_what_is_inside(angle: float, low: float, span: float) -> None:
    limits = (low, low + span)
    assert low - 1e-9 <= fold(angle, limits) <= low + span + 1e-9
    inside = min(max(angle, low), low + span)
    assert fold(inside, limits) == pytest.approx(inside, abs=1e-9)


def test_tracking_turns_to_what_it_sees_no_faster_than_its_rate_and_stays() -> None:
    beacon = BeaconSpec(at=(4.0, 2.4))
    angles = pans({"kind": "tracking", "rate": 1.0}, 10, (beacon,))
    target = atan2(2.4, 4.0)
    assert angles == pytest.approx([min(0.1 * k, target) for k in range(10)])


def test_tracking_scans_until_it_sees_something() -> None:
    beacon = BeaconSpec(at=(-4.0, -0.5))
    angles = pans({"kind": "tracking", "rate": 1.0}, 60, (beacon,))
    assert angles[20] == pytest.approx(2.0)
    assert angles[-1] == pytest.approx(atan2(-0.5, -4.0))


def test_tracking_scans_between_its_limits() -> None:
    angles = pans({"kind": "tracking", "rate": 1.0, "limits": [-0.2, 0.3]}, 9)
    assert angles == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.2, 0.1, 0.0, -0.1, -0.2], abs=1e-12)


def test_tracking_stops_at_its_limit_and_does_not_go_through_it() -> None:
    beacon = BeaconSpec(at=(4.0, 2.4))
    angles = pans({"kind": "tracking", "rate": 1.0, "limits": [-3.0, 0.25]}, 30, (beacon,))
    assert max(angles) == angles[-1] == 0.25


def test_tracking_follows_the_beacon_it_was_given() -> None:
    beacons = (BeaconSpec(at=(4.0, 0.4), colour="red"), BeaconSpec(at=(4.0, -2.0), colour="green"))
    assert pans({"kind": "tracking", "beacon": 1}, 20, beacons)[-1] == pytest.approx(atan2(-2.0, 4.0))
    assert pans({"kind": "tracking"}, 20, beacons)[-1] == pytest.approx(atan2(0.4, 4.0))
    assert pans({"kind": "tracking", "angle": -0.6}, 20, beacons)[-1] == pytest.approx(atan2(-2.0, 4.0))


def test_tracking_stays_with_the_beacon_it_had_though_another_comes_nearer_to_the_middle() -> None:
    beacons = (BeaconSpec(at=(4.0, 1.0), colour="red"), BeaconSpec(at=(4.0, -1.0), colour="green"))
    bench = Bench({"pan": {"kind": "tracking", "rate": 0.2, "angle": 0.2}}, beacons)
    for k in range(60):
        bench.expose(1, Pose(0.0, 0.0, -min(0.04 * k, 0.6)))
    assert bench.pans[-1] == pytest.approx(atan2(1.0, 4.0) + 0.6)


def test_tracking_knows_nothing_while_the_camera_is_blind() -> None:
    """With a beacon right ahead it stands still; once blind it scans, since its own frames show nothing."""
    bench = Bench({"pan": {"kind": "tracking", "rate": 1.0}}, (BeaconSpec(at=(4.0, 0.0)),))
    bench.expose(3)
    bench.effects.blind = True
    bench.expose(5)
    bench.effects.blind = False
    bench.expose(3)
    assert bench.pans == pytest.approx([0.0, 0.0, 0.0, 0.5, 0.4, 0.3])


def test_tracking_keeps_a_beacon_in_view_of_a_turning_robot_on_rendered_frames() -> None:
    bench = Bench({"pan": {"kind": "tracking", "rate": 2.0}, "fov_deg": 60}, BEACONS[:1], rendered=True)
    for k in range(80):
        bench.expose(1, Pose(0.3, 0.2, wrap(0.1 * k)))
    bench.camera.close()
    assert len(bench.notes.readings) == 80
    errors = [wrap(reading.value[0] - true) for reading, _, true in bench.notes.readings]
    assert max(map(abs, errors)) < 1e-3
    # A full turn and more has been followed, one frame's rotation behind.
    offsets = [
        abs(wrap(r.value[0] - s.pan))
        for (r, _, _), s in zip(bench.notes.readings, bench.notes.snapshots, strict=True)
    ]
    assert max(offsets[10:]) == pytest.approx(0.1, abs=0.01)


def test_a_beacon_that_cannot_be_recognised_is_not_followed() -> None:
    twins = (BeaconSpec(at=(4.0, 0.0)), BeaconSpec(at=(0.0, 4.0)), BeaconSpec(at=(0.0, -4.0), colour="blue"))
    for beacon, more in ((1, {}), (7, {}), (2, {"identity": "anonymous"})):
        with pytest.raises(ScenarioError, match=f"beacon {beacon}"):
            Bench({"pan": {"kind": "tracking", "beacon": beacon}, **more}, twins)
    Bench({"pan": {"kind": "tracking", "beacon": 2}}, twins)


@pytest.mark.parametrize(
    "pan",
    [
        {"kind": "spinning"},
        {"kind": "fixed", "rate": 1.0},
        {"kind": "scanning", "limits": [0.5, -0.5]},
        {"kind": "scanning", "limits": [0.5, 1.0]},
        {"kind": "tracking", "rate": 0.0},
        {"kind": "tracking", "beacon": -1},
        {"kind": "fixed", "angle": float("nan")},
    ],
)
def test_an_axis_that_cannot_be_is_refused(pan: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        CameraSpec.model_validate({"pan": pan})


def test_angles_are_reported_wrapped() -> None:
    assert pans({"kind": "fixed", "angle": 1.5 * pi}, 1) == [pytest.approx(-0.5 * pi)]
