from __future__ import annotations

from cmath import phase, rect
from math import atan2, cos, exp, pi, sin, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from hilbed.estimation.attitude import Motion, decayed, global_step, s1_step, so2_step
from hilbed.types import Array

headings = st.floats(-pi, pi)
speeds = st.floats(0.05, 1.0) | st.floats(-1.0, -0.05)
turn_rates = st.floats(-3.0, 3.0)
S = np.array([[0.0, -1.0], [1.0, 0.0]])


def arc(v: float, w: float, T: float, heading: complex = 1 + 0j) -> complex:
    """The way along a held twist by scipy."""
    f = lambda t, _: (v * cos(w * t), v * sin(w * t))  # noqa: E731
    x, y = solve_ivp(f, (0, T), (0, 0), rtol=1e-11, atol=1e-13).y[:, -1]
    return complex(x, y) * heading


def motion(v: float, w: float, T: float, heading: complex) -> Motion:
    return Motion(arc(v, w, T), w * T, v * v * T, arc(v, w, T, heading))


def matrix(heading: complex) -> Array:
    return np.array([[heading.real, -heading.imag], [heading.imag, heading.real]])


@given(headings, headings, speeds, turn_rates, st.floats(0.01, 1.0), st.floats(0.1, 50))
def test_the_error_has_its_closed_form_on_so2_and_s1(
    yaw: float, guess: float, v: float, w: float, T: float, alpha: float
) -> None:
    """tan(e/2) = tan(e₀/2) exp(−α ∫ν²), however long the step."""
    truth, first = rect(1, yaw), rect(1, guess)
    step = motion(v, w, T, truth)
    e0 = phase(truth / first)
    after = 2 * atan2(sin(e0 / 2) * exp(-alpha * v * v * T), cos(e0 / 2))
    turned = truth * rect(1, w * T)
    expected = turned * rect(1, -after)
    R = so2_step(matrix(first), step, alpha)
    np.testing.assert_allclose(R, matrix(expected), atol=1e-7)
    assert s1_step(first, step, alpha) == pytest.approx(expected, abs=1e-7)


@given(headings, headings, speeds, turn_rates, st.floats(0.01, 1.0), st.floats(0.1, 20))
def test_the_error_of_the_global_observer_has_its_closed_form(
    yaw: float, guess: float, v: float, w: float, T: float, g: float
) -> None:
    """|Θ̃| = |Θ̃₀| exp(−g ∫ν²), from anywhere in the plane."""
    truth, first = rect(1, yaw), 3.0 * rect(1, guess)
    after = global_step(first, motion(v, w, T, truth), g)
    left = after - truth * rect(1, w * T)
    assert abs(left) == pytest.approx(abs(first - truth) * exp(-g * v * v * T), abs=1e-7)


def test_so2_equals_an_integration_of_the_papers_matrix_equation() -> None:
    """R̂' = Ω R̂ S, Ω = ω + α vᵀ S v̂, v̂ = ν R̂ e₁, written with matrices; ν is negative."""
    v, w, T, alpha, yaw, guess = -0.4, 0.8, 0.7, 6.0, 0.5, -1.9

    def rates(t: float, x: Array) -> Array:
        R = x.reshape(2, 2)
        velocity = v * np.array((cos(yaw + w * t), sin(yaw + w * t)))
        Ω = w + alpha * velocity @ S @ (v * R[:, 0])
        return np.asarray(Ω * R @ S).ravel()

    oracle = solve_ivp(rates, (0, T), matrix(rect(1, guess)).ravel(), rtol=1e-11, atol=1e-12).y[:, -1]
    ours = so2_step(matrix(rect(1, guess)), motion(v, w, T, rect(1, yaw)), alpha)
    np.testing.assert_allclose(ours.ravel(), oracle, atol=1e-9)


def test_global_equals_an_integration_with_xi_and_a_speed_that_changes() -> None:
    """Θ̄ = ξ + g ν p, ξ' = ω S Θ̄ − g ν² Θ̄ − g ν' p with ν(t) smooth; ours sees positions each 2 ms."""
    g, yaw, w = 4.0, 0.3, 0.7

    def speed(t: float) -> float:
        return 0.4 + 0.3 * sin(2 * t)

    def rates(t: float, x: Array) -> list[float]:
        ξ, p = x[:2], x[2:]
        ν, slope = speed(t), 0.6 * cos(2 * t)
        Θ = ξ + g * ν * p
        dξ = w * S @ Θ - g * ν**2 * Θ - g * slope * p
        return [*dξ.tolist(), ν * cos(yaw + w * t), ν * sin(yaw + w * t)]

    T, n = 2.0, 1000
    t = np.linspace(0, T, n + 1)
    p0, first = np.array((1.0, -2.0)), np.array((-1.5, 0.5))
    start = [*(first - g * speed(0) * p0).tolist(), *p0.tolist()]
    rows = solve_ivp(rates, (0, T), start, t_eval=t, rtol=1e-11, atol=1e-12).y
    oracle = rows[:2, -1] + g * speed(T) * rows[2:, -1]
    heading, p = complex(*first), rows[2] + 1j * rows[3]
    for k in range(n):
        v, h = speed(0.5 * float(t[k] + t[k + 1])), T / n
        chord = v * h * sin(0.5 * w * h) / (0.5 * w * h)
        step = Motion(chord * rect(1, 0.5 * w * h), w * h, v * v * h, complex(p[k + 1] - p[k]))
        heading = global_step(heading, step, g)
    assert (heading.real, heading.imag) == pytest.approx(tuple(oracle), abs=2e-6)


def test_a_rotation_stays_one() -> None:
    R, step = matrix(rect(1, 2.0)), motion(0.5, 1.0, 0.01, rect(1, 0.3))
    for _ in range(20000):
        R = so2_step(R, step, 5.0)
    np.testing.assert_allclose(R @ R.T, np.eye(2), atol=1e-10)


def test_a_standing_robot_shows_nothing_and_its_turn_is_followed() -> None:
    still = Motion(0j, 0.3, 0.0, 0.01 + 0.01j)
    assert so2_step(np.eye(2), still, 5.0) == pytest.approx(matrix(rect(1, 0.3)))
    assert s1_step(1 + 0j, still, 5.0) == pytest.approx(rect(1, 0.3))
    assert global_step(0.5 + 0j, still, 5.0) == pytest.approx(0.5 * rect(1, 0.3))


def test_a_position_that_did_not_move_where_wheels_did_corrects_nothing() -> None:
    slipped = Motion(0.1 + 0j, 0.2, 0.1, 0j)
    assert s1_step(1 + 0j, slipped, 5.0) == pytest.approx(rect(1, 0.2))


@given(headings, st.floats(0, 30))
def test_an_error_decays_without_changing_sides_and_half_a_turn_stays(e0: float, exponent: float) -> None:
    e = decayed(e0, exponent)
    assert abs(e) <= abs(e0) + 1e-12
    assert e * e0 >= 0
    if abs(e0) < 3.0:
        assert tan(e / 2) == pytest.approx(tan(e0 / 2) * exp(-exponent), rel=1e-6, abs=1e-12)
    assert decayed(pi, 0.1) == pytest.approx(pi)
