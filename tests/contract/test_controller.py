"""What every Controller does, on every reference: finite, limited commands for any estimate."""

from __future__ import annotations

from math import isfinite, pi
from typing import Any, get_args

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hilbed.build.minds import Guidance, make_controller
from hilbed.control import ControllerSpec, ReferenceSpec
from hilbed.types import Estimate

CONTROLLERS: dict[str, Any] = {spec.model_fields["kind"].default: spec for spec in get_args(ControllerSpec)}
REFERENCES: dict[str, Any] = {
    get_args(spec.model_fields["kind"].annotation)[0]: spec for spec in get_args(ReferenceSpec)
}
MOVING = {"speed": 0.6}
BLOCKS: dict[str, dict[str, Any]] = {
    **dict.fromkeys(REFERENCES, MOVING),
    "waypoints": {"points": [(0, 0), (2, 0), (3, 2)], **MOVING},
    "legs": {},
    "point": {"pose": (1.0, 3.0, -1.5)},
}
FASTEST = 1.3, 4.0  # m/s, rad/s: limits of the controllers, and more than these references ask for
UNLIMITED = "lyapunov", "path_following", "ramps"  # their robots limit what they ask for
TRACKERS = "lqr", "open_loop", "lyapunov", "front_point"

metres = st.floats(-1e6, 1e6)
poses = st.tuples(metres, metres, st.floats(-pi, pi))
times = st.integers(0, 10**12)


def controllers(kind: str, reference: str, acceleration: float | None = None) -> Any:
    block = {"kind": reference, **BLOCKS[reference]}
    if "speed" in block:
        block["acceleration"] = acceleration
    path = REFERENCES[reference].model_validate(block).build()
    fast_enough = {"max_speed": FASTEST[0]} if "max_speed" in CONTROLLERS[kind].model_fields else {}
    return make_controller(CONTROLLERS[kind](**fast_enough), Guidance(path, 10_000_000)), path


@pytest.mark.parametrize("reference", REFERENCES)
@pytest.mark.parametrize("kind", CONTROLLERS)
@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(times, poses), min_size=1, max_size=10), st.sampled_from([None, 0.3]))
def test_commands_are_finite_limited_and_do_not_depend_on_the_past(
    kind: str, reference: str, asked: list[tuple[int, tuple[float, float, float]]], acceleration: float | None
) -> None:
    controller, _ = controllers(kind, reference, acceleration)
    commands = []
    for t, pose in asked:
        mean = np.array(pose)
        command = controller.step(t, Estimate(t, mean, np.eye(3)))
        assert isfinite(command.v)
        assert isfinite(command.w)
        assert kind in UNLIMITED or (abs(command.v) <= FASTEST[0] and abs(command.w) <= FASTEST[1])
        assert np.array_equal(mean, pose)
        commands.append(command)
    fresh, _ = controllers(kind, reference, acceleration)
    for (t, pose), command in reversed(list(zip(asked, commands, strict=True))):
        assert fresh.step(t, Estimate(t, np.array(pose), np.eye(3))) == command


@pytest.mark.parametrize("reference", REFERENCES)
@pytest.mark.parametrize("kind", TRACKERS)
@settings(max_examples=25, deadline=None)
@given(times)
def test_on_the_reference_it_asks_for_the_reference(kind: str, reference: str, t: int) -> None:
    controller, path = controllers(kind, reference)
    pose, v, w = path.at(t)
    assert controller.step(t, Estimate(t, np.array(pose), np.eye(3))) == pytest.approx((v, w), abs=1e-9)
