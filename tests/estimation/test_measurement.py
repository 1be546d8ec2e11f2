from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hilbed.angles import wrap
from hilbed.estimation.measurement import MODELS
from hilbed.types import Pose
from tests.estimation.experiment import sight

places = st.floats(-5, 5)
poses = st.tuples(places, places, st.floats(-3.1, 3.1))
mounts = st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))


@given(poses, st.tuples(places, places), mounts)
def test_predictions_are_what_the_sensor_sees(
    pose: tuple[float, float, float], beacon: tuple[float, float], mount: tuple[float, float]
) -> None:
    azimuth, distance = sight(Pose(*pose), beacon, mount)
    assume(distance > 0.1)
    state = np.array(pose)
    assert wrap(MODELS["azimuth"].predict(state, beacon, mount).value - azimuth) == pytest.approx(0, abs=1e-9)
    assert MODELS["range"].predict(state, beacon, mount).value == pytest.approx(distance)
    assert MODELS["azimuth"].predict(state, beacon, mount).per_metre == pytest.approx(1 / distance)


@given(poses, st.tuples(places, places), mounts, st.sampled_from(sorted(MODELS)))
def test_gradients_are_derivatives(
    pose: tuple[float, float, float], beacon: tuple[float, float], mount: tuple[float, float], kind: str
) -> None:
    assume(sight(Pose(*pose), beacon, mount)[1] > 0.3)
    predict, difference = MODELS[kind]
    state, h = np.array(pose), 1e-6
    numeric = [
        difference(predict(state + h * e, beacon, mount).value, predict(state - h * e, beacon, mount).value)
        / (2 * h)
        for e in np.eye(3)
    ]
    assert predict(state, beacon, mount).gradient == pytest.approx(numeric, abs=1e-6)


@pytest.mark.parametrize("kind", sorted(MODELS))
def test_a_robot_on_the_beacon_gets_finite_numbers(kind: str) -> None:
    expected = MODELS[kind].predict(np.zeros(3), (0.0, 0.0), (0.0, 0.0))
    assert np.isfinite([expected.value, *expected.gradient, expected.per_metre]).all()
