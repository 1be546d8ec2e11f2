"""The filter beside two others: plain numpy in covariance form, and filterpy used by hand."""

from __future__ import annotations

import numpy as np
from filterpy.kalman import ExtendedKalmanFilter

from hilbed.estimation.ekf import Ekf
from hilbed.estimation.measurement import MODELS
from hilbed.estimation.odometry_model import OdometryModel
from hilbed.estimation.specs import EkfSpec, OdometrySpec
from hilbed.types import Array, Odometry, Pose
from tests.estimation.experiment import BEACONS, START, Errors, Step, exact_arc, experiment, sight

MODEL = OdometryModel()
MOUNT = (0.1, -0.05)
STEPS = experiment(3, 200, Errors(mount=MOUNT), ("azimuth", "range"))


def run_ekf(steps: list[Step], spec: EkfSpec) -> tuple[Array, Array]:
    ekf = Ekf(spec, BEACONS, START, MOUNT)
    estimates = [ekf.step(step.t, step.odometry, step.readings) for step in steps]
    return np.array([e.mean for e in estimates]), np.array([e.covariance for e in estimates])


def expected(kind: str, x: Array, beacon: tuple[float, float]) -> float:
    azimuth, distance = sight(Pose(*x), beacon, MOUNT)
    return azimuth if kind == "azimuth" else distance


def numeric_gradient(kind: str, x: Array, beacon: tuple[float, float]) -> Array:
    h = 1e-6
    pairs = [(expected(kind, x + h * e, beacon), expected(kind, x - h * e, beacon)) for e in np.eye(3)]
    return np.array([[np.remainder(a - b + np.pi, 2 * np.pi) - np.pi for a, b in pairs]]) / (2 * h)


def textbook_motion(yaw: float, odometry: Odometry) -> tuple[Array, Array, Array]:
    """Returns the change of state, its Jacobian and its noise covariance."""
    ds, turn = odometry.distance, odometry.turn

    def change(ds: float, turn: float) -> Array:
        x, y, _ = exact_arc(Pose(0.0, 0.0, yaw), ds, turn, 0.0)
        return np.array((x, y, turn))

    h = 1e-6
    by_ds, by_turn = change(ds + h, turn) - change(ds - h, turn), change(ds, turn + h) - change(ds, turn - h)
    G = np.column_stack((by_ds, by_turn)) / (2 * h)
    dx, dy, _ = change(ds, turn)
    F = np.eye(3)
    F[:2, 2] = -dy, dx
    variances = (
        MODEL.distance_noise**2 * ds,
        MODEL.heading_noise**2 * ds + MODEL.turn_noise**2 * abs(turn),
    )
    return change(ds, turn), F, G @ np.diag(variances) @ G.T


def run_numpy(steps: list[Step]) -> tuple[Array, Array]:
    """The textbook filter with numeric Jacobians; the short form of the covariance."""
    x, P, rows = np.array(START), np.diag([1e-4] * 3), []
    for step in steps:
        change, F, Q = textbook_motion(x[2], step.odometry)
        x = x + change
        P = F @ P @ F.T + Q
        for reading in step.readings:
            beacon = BEACONS[reading.beacon or 0]
            H = numeric_gradient(reading.kind, x, beacon)
            innovation = reading.value[0] - expected(reading.kind, x, beacon)
            if reading.kind == "azimuth":
                innovation = np.remainder(innovation + np.pi, 2 * np.pi) - np.pi
            K = P @ H.T / (H @ P @ H.T + reading.std[0] ** 2)
            x = x + K[:, 0] * innovation
            P = P - K @ H @ P
        x[2] = np.remainder(x[2] + np.pi, 2 * np.pi) - np.pi
        rows.append((x.copy(), P.copy()))
    return np.array([x for x, _ in rows]), np.array([P for _, P in rows])


def test_equals_a_textbook_filter() -> None:
    means, covariances = run_ekf(STEPS, EkfSpec(gate=None))
    oracle_means, oracle_covariances = run_numpy(STEPS)
    np.testing.assert_allclose(means, oracle_means, atol=1e-7)
    np.testing.assert_allclose(covariances, oracle_covariances, atol=1e-9)


def test_equals_filterpy_by_hand() -> None:
    plain = ExtendedKalmanFilter(3, 1)
    plain.x, plain.P = np.array(START), np.diag([1e-4] * 3)
    for step in STEPS:
        change, plain.F, plain.Q = textbook_motion(plain.x[2], step.odometry)
        before = plain.x + change
        plain.predict()
        plain.x = before
        for reading in step.readings:
            predict, difference = MODELS[reading.kind]
            beacon = BEACONS[reading.beacon or 0]
            plain.update(
                np.array(reading.value),
                HJacobian=lambda x, p=predict, b=beacon: np.array([p(x, b, MOUNT).gradient]),
                Hx=lambda x, p=predict, b=beacon: np.array([p(x, b, MOUNT).value]),
                R=reading.std[0] ** 2,
                residual=lambda a, b, d=difference: np.array([d(a[0], b[0])]),
            )
    means, covariances = run_ekf(STEPS, EkfSpec(gate=None))
    np.testing.assert_allclose(np.sin(means[-1]), np.sin(plain.x), atol=1e-9)
    np.testing.assert_allclose(covariances[-1], plain.P, atol=1e-11)


def test_yaw_stays_wrapped_over_many_turns() -> None:
    means, _ = run_ekf(experiment(1, 800, Errors(mount=MOUNT)), EkfSpec())
    assert np.all(np.abs(means[:, 2]) <= np.pi)
    assert np.ptp(means[:, 2]) > 6


def test_settings_of_the_spec_reach_the_filter() -> None:
    """Scales, direction, biases and standard deviations undo what is wrong with the data."""
    wrong = Errors(0.1, 0.9, 1.05, 0.01, 0.02, 0.01, MOUNT, 0.0, 0.01, 0.03, 0.02, -0.1)
    steps = experiment(5, 400, wrong, ("azimuth", "range"))
    spec = EkfSpec(odometry=OdometrySpec(direction=0.1, distance_scale=0.9, turn_scale=1.05))
    spec = spec.model_copy(
        update={
            "azimuth": spec.azimuth.model_copy(update={"bias": 0.03, "std": 0.01}),
            "range": spec.range.model_copy(update={"bias": -0.1}),
        }
    )
    means, _ = run_ekf(steps, spec)
    truth = np.array([step.truth for step in steps])
    assert np.sqrt(np.mean(np.sum((means - truth)[:, :2] ** 2, axis=1))) < 0.02
