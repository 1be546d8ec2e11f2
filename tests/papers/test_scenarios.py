"""The papers' ideal experiments as scenarios: through the bench's own cycle, beside the equations."""

from __future__ import annotations

from math import atan, cos, pi, sin, tan

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hilbed.angles import wrap
from hilbed.criteria.pose import turned
from hilbed.criteria.signals import Signals
from hilbed.estimation.consistency import mean_bounds
from hilbed.scenario import bundled
from tests.bench import Ran, ran

PAPERS = ("ishikawa1994/", "bui2022/", "lages2017/", "pliego2023/")
IDEAL = [name for name in bundled.names() if name.startswith(PAPERS) and not name.endswith("-bench")]


@pytest.mark.parametrize("name", IDEAL)
def test_it_shows_what_the_paper_shows_or_that_it_does_not(name: str) -> None:
    assert ran(name).verdict["reason"] == ""


def test_all_experiments_of_the_contract_are_there() -> None:
    """DESIGN.md, section 6."""
    ishikawa = [
        "estimation-lyapunov",
        "estimation-lyapunov-mended",
        "estimation-ekf",
        "estimation-elo",
        "reverse",
    ]
    bui = [f"test{test}-type{kind}" for test in (1, 2, 3) for kind in (1, 2)]
    bui += ["open-loop", "open-loop-noise", "closed-loop", "closed-loop-noise", "ekf"]
    lages = [
        f"{n}{law}" for n in ("single", *(f"start-{k}" for k in range(1, 9))) for law in ("", "-printed")
    ]
    pliego = ["observer-so2", "observer-s1", "observer-global", "circle", "eight"]
    named = zip(PAPERS, (ishikawa, bui, lages, pliego), strict=True)
    assert sorted(IDEAL) == sorted(paper + name for paper, names in named for name in names)


def yaw_error(run: Ran) -> np.ndarray:
    """Truth minus estimate (N,)."""
    return -np.asarray(turned(Signals(run.signals), "estimate"))


@pytest.mark.parametrize("form", ["so2", "s1"])
@pytest.mark.parametrize("error", [2.5, 3.0, -1.0])
def test_the_heading_error_has_its_closed_form(form: str, error: float) -> None:
    """tan(e/2) = tan(e₀/2) exp(−α ∫ν²), α = 5, ν = 0.3."""
    run = ran(f"pliego2023/observer-{form}", f"estimator.heading_error={error}", "duration=10")
    expected = 2 * np.arctan(tan(error / 2) * np.exp(-5 * 0.09 * run.signals["t"]))
    np.testing.assert_allclose(yaw_error(run), expected, atol=1e-6)


@pytest.mark.parametrize("error", [2.5, 3.1, -1.0])
def test_the_global_observers_error_shrinks_and_turns_with_the_robot(error: float) -> None:
    """Θ̃ = exp(i∫ω) Θ̃₀ exp(−g ∫ν²), so that Θ̄ = Θ (1 − (1 − exp(−i e₀)) exp(−g ∫ν²))."""
    run = ran("pliego2023/observer-global", f"estimator.heading_error={error}", "duration=10")
    left = np.exp(-5 * 0.09 * run.signals["t"])
    expected = -np.angle(1 - (1 - np.exp(-1j * error)) * left)
    np.testing.assert_allclose(yaw_error(run), expected, atol=1e-6)


def test_lyapunov_tracking_equals_an_integration_with_inputs_held() -> None:
    """(3.13) and (2.4) by scipy, from the reference of section 3.1 in its own words."""
    truth = ran("bui2022/closed-loop").signals["truth"]
    state = np.array((-20.0, 3.0, 0.0))
    for k in range(500):
        (x, y, course), v_r, w_r = legs(0.1 * k)
        dx, dy, e = x - state[0], y - state[1], wrap(course - state[2])
        c, s = cos(state[2]), sin(state[2])
        u1 = v_r * cos(e) + 0.5 * (c * dx + s * dy)
        u2 = w_r + v_r * (0.5 * (c * dy - s * dx) + 0.5 * sin(e))
        v, γ = min(max(u1, -1.74), 1.74), min(max(atan(u2 / u1), -pi / 4), pi / 4)
        state = held(state, v, v * tan(γ), 0.1)
        np.testing.assert_allclose(truth[k + 1, :2], state[:2], atol=1e-6)


def legs(t: float) -> tuple[tuple[float, float, float], float, float]:
    """The reference's pose and speeds: a line, half a circle of 4 m clockwise, a line back."""
    if t < 20 - 1e-9:
        return (-20 + t, 4.0, 0.0), 1.0, 0.0
    if t < 30 - 1e-9:
        turned_by = pi * (t - 20) / 10
        return (4 * sin(turned_by), 4 * cos(turned_by), -turned_by), 0.4 * pi, -pi / 10
    return (-(t - 30), -4.0, pi), 1.0, 0.0


def held(state: np.ndarray, v: float, w: float, T: float) -> np.ndarray:
    """The unicycle by scipy with speeds held over T."""
    rates = lambda _, p: (v * cos(p[2]), v * sin(p[2]), w)  # noqa: E731
    return np.asarray(solve_ivp(rates, (0, T), state, rtol=1e-10, atol=1e-12).y[:, -1])


@pytest.mark.parametrize("kind", [1, 2])
def test_a_ramped_test_equals_an_integration_with_inputs_held(kind: int) -> None:
    signals = ran(f"bui2022/test3-type{kind}").signals
    state = np.zeros(3)
    for k in range(100):
        v, γ = min(0.02 * k, 1.68), min(0.05 * k, pi / 4)
        assert signals["command"][k] == pytest.approx((v, γ))
        state = held(state, v * cos(γ), v * sin(γ), 0.1) if kind == 1 else held(state, v, v * tan(γ), 0.1)
    end = signals["truth"][-1]
    assert (*end[:2], wrap(end[2] - state[2])) == pytest.approx((*state[:2], 0.0), abs=1e-6)


def test_backwards_along_the_line_is_what_its_commands_make() -> None:
    """Truth of the first second from the recorded commands, by scipy; θ' = v tan γ / d."""
    signals = ran("ishikawa1994/reverse", "duration=1").signals
    state = np.array((3.0, 1.0, -0.8))
    for v, γ in signals["command"][:-1].tolist():
        state = held(state, v, v * tan(γ), 1e-3)
    np.testing.assert_allclose(signals["truth"][-1], state, atol=1e-6)


@pytest.mark.slow
def test_the_kalman_filter_of_chapter_4_is_consistent_over_50_seeds() -> None:
    """NEES of the pose and NIS of four readings a step, mean over runs inside its 95 % bounds."""
    runs = [ran("bui2022/ekf", seed=seed) for seed in range(50)]
    errors = np.array([nees(run) for run in runs])
    nis = np.array([run.signals["nis/value"].reshape(-1, 4).sum(axis=1) for run in runs])
    for values, dof in ((errors, 3), (nis, 4)):
        low, high = mean_bounds(dof, len(runs))
        mean = values.mean(axis=0)
        assert np.mean((mean > low) & (mean < high)) >= 0.9


def nees(run: Ran) -> np.ndarray:
    error = run.signals["estimate"] - run.signals["truth"]
    error[:, 2] = -yaw_error(run)
    return np.einsum("ni,nij,nj->n", error, np.linalg.inv(run.signals["covariance"]), error)
