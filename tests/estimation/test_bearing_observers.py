from __future__ import annotations

from collections.abc import Callable
from math import copysign, cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from hilbed.angles import wrap
from hilbed.estimation.bearing_kalman import KalmanBucy, Noise, SampledKalman, sound
from hilbed.estimation.bearing_observers import FARTHEST, NEAREST, Luenberger, Lyapunov, Observer, State
from hilbed.estimation.bearing_travel import Leg, travelled
from hilbed.estimation.consistency import mean_bounds
from hilbed.types import Array

STEP = 1e-3
R0, PHI0 = 2.2, -1.6  # the true sight at the start of every oracle run
NOISE = Noise(P0=(1.0, 0.1))


def truth(s: Array, u: float) -> tuple[Array, Array]:
    """Sight (r, φ) of the origin along an arc of curvature u, from (R0, PHI0), in closed form."""
    x, y = R0 + s * 0.0, s * 0.0  # robot at (R0, 0) as seen from the landmark, so θ = φ there
    yaw = PHI0 + u * s
    if u:
        x, y = x + (np.sin(yaw) - sin(PHI0)) / u, y - (np.cos(yaw) - cos(PHI0)) / u
    else:
        x, y = x + s * cos(PHI0), y + s * sin(PHI0)
    return np.hypot(x, y), yaw - np.arctan2(y, x)


def lyapunov(r: float, phi: float, m: float) -> list[float]:
    ε1, ε2, k = 1e-2, 2e-4, 4.0
    error = m - phi
    k1 = copysign(1, sin(m)) * k * error / (4 * (ε2 - ε1**2) * r**2)
    k2 = k * ε2 * error / (4 * ε1 * (ε2 - ε1**2) * r**2)
    return [cos(m) + k1, -sin(m) / r + k2]


def luenberger(r: float, phi: float, m: float) -> list[float]:
    s = copysign(max(abs(sin(phi)), 0.2), sin(phi))
    k1, k2 = 64 * r**2 / s - sin(phi), 16 + 2 * cos(phi) / r
    return [cos(phi) + k1 * (m - phi), -sin(phi) / r + k2 * (m - phi)]


def kalman(x: Array, m: float) -> list[float]:
    r, phi = x[:2]
    P = np.array([[x[2], x[3]], [x[3], x[4]]])
    F = np.array([[0, -sin(phi)], [sin(phi) / r**2, -cos(phi) / r]])
    H = np.array([[0.0, 1.0]])
    K = P @ H.T / 1e-3
    dP = F @ P + P @ F.T + np.diag([1e3, 0.2]) - K @ H @ P
    dx = np.array([cos(phi), -sin(phi) / r]) + K[:, 0] * (m - phi)
    return [*dx.tolist(), dP[0, 0], dP[0, 1], dP[1, 1]]


ORACLES: list[tuple[Observer, Callable[[Array, float], list[float]]]] = [
    (Lyapunov(epsilon_2=2e-4), lambda x, m: lyapunov(x[0], x[1], m)),
    (Luenberger(), lambda x, m: luenberger(x[0], x[1], m)),
    (KalmanBucy(NOISE), kalman),
]


@pytest.mark.parametrize("u", [0.0, 0.4])
@pytest.mark.parametrize("case", range(3))
def test_observers_equal_an_integration_of_the_papers_equations(case: int, u: float) -> None:
    """φ is continuous in the oracle; the observer has it each millimetre and takes it as straight between."""
    observer, equations = ORACLES[case]
    length = 1.0
    start = observer.start(1.0, PHI0)

    def rates(s: float, x: Array) -> list[float]:
        dr, dphi, *dP = equations(x, float(truth(np.array(s), u)[1]))
        return [dr, dphi + u, *dP]

    oracle = solve_ivp(rates, (0, length), start, method="LSODA", rtol=1e-10, atol=1e-10).y[:, -1]
    s = np.linspace(0, length, round(length / STEP) + 1)
    phi = truth(s, u)[1]
    x = start
    for a, b in zip(phi[:-1].tolist(), phi[1:].tolist(), strict=True):
        x = travelled(observer, x, Leg(STEP, u * STEP, (a, b)), STEP)
    assert x[:2] == pytest.approx(oracle[:2], abs=3e-6)
    assert x[2:] == pytest.approx(oracle[2:], rel=1e-5, abs=1e-7)


@given(st.floats(0.3, 9), st.floats(0.3, 9), st.floats(-3, 3), st.floats(-1, 1))
def test_the_mended_gains_give_the_lyapunov_function_its_derivative(
    r: float, ratio: float, phi: float, error: float
) -> None:
    """V' of the exact error system (15), with + r̃ sin φ/(r r̂), has no cross terms."""
    law = Lyapunov(epsilon_2=2e-4)
    estimated = r / ratio
    behind = r - estimated
    k1, k2 = (g * error for g in law.gain(estimated, phi))
    dr, dphi = -k1, behind * sin(phi) / (r * estimated) - k2
    ε = copysign(law.epsilon_1, sin(phi))
    rate = (law.epsilon_2 * behind - ε * error) * dr + (error - ε * behind) * dphi
    a = sin(phi) / (r * estimated)
    form = -abs(a) * law.epsilon_1 * behind**2 + a * behind * error
    form -= law.k * error**2 / (4 * law.epsilon_1 * estimated**2)
    assert rate == pytest.approx(form, rel=1e-6, abs=1e-6 * (1 + abs(k1) + abs(k2)))
    if estimated * abs(sin(phi)) < law.k * r:
        assert form <= 1e-12


@given(st.floats(0.5, 20), st.floats(0.3, 2.8), st.sampled_from([-1, 1]))
def test_the_luenberger_error_has_the_poles_it_is_given(r: float, phi: float, side: int) -> None:
    """Linearised at the truth, by differences: s² + (p₂ + 3 cos φ/r) s + p₁, which is as given abeam."""
    observer, x = Luenberger(), np.array((r, side * phi))

    def rates(x: Array) -> Array:
        return np.array(observer.rates((float(x[0]), float(x[1])), side * phi))

    h = 1e-6
    A = np.array([(rates(x + h * e) - rates(x - h * e)) / (2 * h) for e in np.eye(2)]).T
    assert np.poly(A) == pytest.approx([1, 16 + 3 * cos(phi) / r, 64], rel=1e-5)


@given(st.floats(0.3, 9), st.floats(-pi, pi))
def test_the_luenberger_gain_is_floored_where_the_axis_passes_through_the_landmark(
    r: float, phi: float
) -> None:
    k1, _ = Luenberger(floor=0.2).gain(r, phi)
    assert abs(k1) <= 64 * r * r / 0.2 + 1
    assert copysign(1, k1 + sin(phi)) == copysign(1, sin(phi))


def test_a_noisy_luenberger_observer_survives_the_axis_with_the_floor() -> None:
    """Past a landmark that is straight ahead; without a floor the same run loses it."""

    def error(floor: float) -> float:
        rng = np.random.default_rng(4)
        s = np.linspace(0, 4, 4001)
        r, phi = np.hypot(5 - s, 0.05), np.arctan2(-0.05, s - 5) * -1
        phi = phi + rng.normal(0, 2e-3, len(s))
        observer, x = Luenberger(floor=floor), (5.0, float(phi[0]))
        worst = 0.0
        for k in range(4000):
            x = travelled(observer, x, Leg(STEP, 0.0, (float(phi[k]), float(phi[k + 1]))), STEP)
            worst = max(worst, abs(x[0] - float(r[k + 1])))
        return worst

    assert error(0.2) < 4.0
    assert error(1e-3) > 10.0


@pytest.mark.parametrize("observer", [Lyapunov(epsilon_2=2e-4), Luenberger(), KalmanBucy(), SampledKalman()])
@given(st.floats(0.5, 5), st.floats(-3, 3), st.floats(-0.2, 0.2), st.floats(-0.3, 0.3))
def test_backwards_is_forwards_with_the_heading_turned(
    observer: Observer, r: float, phi: float, error: float, turn: float
) -> None:
    """(20) in z: p₂ → −p₂; the sign of (17) and F of (18) turn with the direction."""
    start = observer.start(r, phi)
    back = travelled(observer, start, Leg(-0.01, turn, (phi + error, phi + error)), STEP)
    mirrored = (start[0], start[1] + pi, *start[2:])
    ahead = travelled(observer, mirrored, Leg(0.01, turn, (phi + error + pi, phi + error + pi)), STEP)
    assert back[0] == pytest.approx(ahead[0], rel=1e-9)
    assert wrap(back[1] - ahead[1] + pi) == pytest.approx(0.0, abs=1e-9)
    assert back[2:] == pytest.approx(ahead[2:], rel=1e-9)


def test_printed_rates_backwards() -> None:
    """Fig. 5's observer in z, written from (20) with p₂ → −p₂, beside ours over a negative way."""
    r, phi, m, h = 1.5, 1.2, 1.25, 1e-6
    back = travelled(Luenberger(), (r, phi), Leg(-h, 0.0, (m, m)), STEP)
    k1, k2 = 64 * r**2 / sin(phi) - sin(phi), -16 + 2 * cos(phi) / r
    printed = cos(phi) + k1 * (m - phi), -sin(phi) / r + k2 * (m - phi)
    assert ((back[0] - r) / -h, (back[1] - phi) / -h) == pytest.approx(printed, rel=1e-4)


def test_the_printed_epsilon_does_not_converge_and_the_mended_one_does() -> None:
    """Landmark A of Fig. 3: r̂ from 1 m, true √5 m, over 3 m straight on."""

    def left(epsilon_2: float) -> float:
        s = np.linspace(0, 3, 3001)
        x, y = 1 + s * cos(-0.5), 2 + s * sin(-0.5)
        r, phi = np.hypot(x, y), -0.5 - np.arctan2(y, x)
        observer = Lyapunov(epsilon_2=epsilon_2)
        state: State = (1.0, float(phi[0]))
        for k in range(3000):
            state = travelled(observer, state, Leg(STEP, 0.0, (float(phi[k]), float(phi[k + 1]))), STEP)
        return abs(state[0] - float(r[-1]))

    assert left(2.0e-3) > 0.1
    assert left(2.0e-4) < 1e-3


def test_the_sampled_filter_equals_a_textbook_filter() -> None:
    """Exact moments by scipy between, the short form of the update."""
    noise = Noise((0.02, 0.001), 1e-4, (1.0, 0.05))
    filter_, x = SampledKalman(noise), np.array((1.8, -1.5))
    P, state = np.diag(noise.P0), (1.8, -1.5, 1.0, 0.0, 0.05)
    for m in (-1.52, -1.49, -1.53):
        oracle = solve_ivp(_moments, (0, 0.05), [*x, *P.ravel()], rtol=1e-11, atol=1e-12).y[:, -1]
        x, P = oracle[:2], oracle[2:].reshape(2, 2)
        K = P[:, 1] / (P[1, 1] + 1e-4)
        nis = (m - x[1]) ** 2 / (P[1, 1] + 1e-4)
        x, P = x + K * (m - x[1]), P - np.outer(K, P[1])
        state = travelled(filter_, state, Leg(0.05, 0.0), STEP)
        assert filter_.nis(state, m, 0.05) == pytest.approx(nis, rel=1e-6)
        state = filter_.corrected(state, m)
        assert state == pytest.approx((x[0], x[1], P[0, 0], P[0, 1], P[1, 1]), rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("form", [KalmanBucy, SampledKalman])
def test_it_is_consistent_with_noise_on_the_motion(form: type[KalmanBucy] | type[SampledKalman]) -> None:
    """NEES of (r, φ) over 50 runs of 1 m: Q on the motion, 5 mrad on a bearing each centimetre."""
    way, std, Q, P0 = 0.01, 5e-3, np.array((1e-3, 1e-4)), np.array((1e-2, 1e-4))
    noise = Noise(tuple(Q.tolist()), std**2 * (way if form is KalmanBucy else 1.0), tuple(P0.tolist()))
    rows = []
    for seed in range(50):
        rng, observer, x = np.random.default_rng(seed), form(noise), np.array((2.0, -1.5))
        state, seen, errors = observer.start(*(x + rng.normal(0, np.sqrt(P0))).tolist()), None, []
        for _ in range(100):
            x = x + way * np.array((cos(x[1]), -sin(x[1]) / x[0])) + rng.normal(0, np.sqrt(Q * way))
            last, seen = seen, float(x[1]) + rng.normal(0, std)
            state = travelled(observer, state, Leg(way, 0.0, (last or seen, seen)), STEP)
            state = observer.corrected(state, seen)
            e, P = x - state[:2], np.array(((state[2], state[3]), (state[3], state[4])))
            errors.append(float(e @ np.linalg.solve(P, e)))
        rows.append(errors)
    low, high = mean_bounds(2, 50)
    mean = np.mean(rows, axis=0)
    assert np.mean((mean > low) & (mean < high)) >= 0.9


def _moments(_: float, x: Array) -> list[float]:
    r, phi, P = x[0], x[1], x[2:].reshape(2, 2)
    F = np.array([[0, -sin(phi)], [sin(phi) / r**2, -cos(phi) / r]])
    return [cos(phi), -sin(phi) / r, *(F @ P + P @ F.T + np.diag((0.02, 0.001))).ravel().tolist()]


@pytest.mark.parametrize(
    "bad", [(-1.0, 0.0, 1.0), (1.0, 2.0, 1.0), (1.0, 0.0, 0.0), (float("nan"), 0.0, 1.0)]
)
def test_a_covariance_that_is_not_positive_starts_afresh(bad: tuple[float, float, float]) -> None:
    assert sound((2.0, 0.3, *bad), (1.0, 0.1)) == (2.0, 0.3, 1.0, 0.0, 0.1)
    for observer in (KalmanBucy(NOISE), SampledKalman(NOISE)):
        rates = observer.rates((2.0, 0.3, *bad), 0.4)
        assert np.isfinite(rates).all()


@pytest.mark.parametrize(
    "observer", [Lyapunov(), Lyapunov(epsilon_2=2e-4), Luenberger(), KalmanBucy(), SampledKalman()]
)
@given(r=st.floats(-5, 200), phi=st.floats(-9, 9), m=st.floats(-9, 9), way=st.floats(-0.05, 0.05))
def test_whatever_is_measured_the_state_stays_finite_and_bounded(
    observer: Observer, r: float, phi: float, m: float, way: float
) -> None:
    """On a landmark, with the axis through it, standing or in leaps."""
    state = travelled(observer, observer.start(r, phi), Leg(way, 0.1, (m, -m)), 1e-2)
    state = observer.corrected(state, m)
    assert NEAREST <= state[0] <= FARTHEST
    assert -pi < state[1] <= pi
    assert np.isfinite(state).all()


def test_standing_teaches_nothing_and_turning_on_the_spot_turns_the_angle() -> None:
    for observer in (Lyapunov(), Luenberger(), KalmanBucy()):
        start = observer.start(2.0, 0.5)
        assert travelled(observer, start, Leg(0.0, 0.0, (0.9, 0.9)), STEP) == pytest.approx(start)
        turned = travelled(observer, start, Leg(0.0, 0.3, (0.9, 0.9)), STEP)
        assert turned[:2] == pytest.approx((2.0, 0.8))
