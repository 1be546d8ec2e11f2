"""The papers' deterministic experiments by scipy, from their equations with misprints mended.

Inputs are held over the scenario's cycle; a bearing goes straight from one exposure to the next.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import atan, copysign, cos, pi, sin, tan
from typing import NamedTuple

import numpy as np
from scipy.integrate import odeint

from hilbed.angles import wrap
from hilbed.types import Array

Rates = Callable[[Array, float], Sequence[float]]
Place = tuple[float, float, float]

S = np.array(((0.0, -1.0), (1.0, 0.0)))


class Expected(NamedTuple):
    """Truth and estimate (N, 3), landmark distance (N,) where one is estimated."""

    truth: Array
    estimate: Array
    distance: Array | None = None


def integrated(rates: Rates, start: Sequence[float] | Array, end: float) -> Array:
    """The state after an independent variable has gone from 0 to `end`."""
    return np.asarray(odeint(rates, start, (0.0, end), rtol=1e-11, atol=1e-12)[-1])


def held(pose: Array, v: float, w: float, T: float) -> Array:
    """The unicycle with speeds held over T."""
    return integrated(lambda p, _: (v * cos(p[2]), v * sin(p[2]), w), pose, T)


# Bui & Duong (2022)


def ramped(test: int, kind: int) -> Expected:
    """(2.3) and (2.4) with d = 1 m; v = 1, 1, 0.2 t; γ = π/6, 0.5 t, 0.5 t; limits 1.68 m/s, π/4."""
    rows = [np.zeros(3)]
    for k in range(100):
        t = 0.1 * k
        v = min(0.2 * t, 1.68) if test == 3 else 1.0
        γ = pi / 6 if test == 1 else min(0.5 * t, pi / 4)
        speeds = (v * cos(γ), v * sin(γ)) if kind == 1 else (v, v * tan(γ))
        rows.append(held(rows[-1], *speeds, 0.1))
    return Expected(np.array(rows), np.array(rows))


def legs(t: float) -> tuple[Place, float, float]:
    """The reference's pose and speeds: a line, half a circle of 4 m clockwise, a line back."""
    if t < 20 - 1e-9:
        return (-20 + t, 4.0, 0.0), 1.0, 0.0
    if t < 30 - 1e-9:
        turned_by = pi * (t - 20) / 10
        return (4 * sin(turned_by), 4 * cos(turned_by), -turned_by), 0.4 * pi, -pi / 10
    return (-(t - 30), -4.0, pi), 1.0, 0.0


def on_legs(start: Place, closed: bool) -> Expected:
    """(3.13) with k = 0.5, or the reference's speeds; γ = atan(u₂ d/u₁), limits 1.74 m/s, π/4."""
    rows = [np.array(start)]
    for k in range(500):
        (x, y, course), u1, u2 = legs(0.1 * k)
        if closed:
            dx, dy, e = x - rows[-1][0], y - rows[-1][1], wrap(course - rows[-1][2])
            c, s = cos(rows[-1][2]), sin(rows[-1][2])
            u1, u2 = (
                u1 * cos(e) + 0.5 * (c * dx + s * dy),
                u2 + u1 * (0.5 * (c * dy - s * dx) + 0.5 * sin(e)),
            )
        v, γ = min(max(u1, -1.74), 1.74), min(max(atan(u2 / u1), -pi / 4), pi / 4)
        rows.append(held(rows[-1], v, v * tan(γ), 0.1))
    return Expected(np.array(rows), np.array(rows))


# Ishikawa & Sampei (1994); z = ±t, cycle 1 mm

LANDMARKS = (0.0, 0.0), (0.0, 1.0)
GUESSED = 1.0, 2**0.5

Law = Callable[[Array, float, float], Sequence[float]]
"""Rates in z of a state (r, φ, …) without steering, for a measured φ and a direction of travel ±1."""


def lyapunov(epsilon_2: float) -> Law:
    """(14) with (16), (17) as mended, ε₁ = 1e-2, k = 4."""

    def rates(x: Array, m: float, way: float) -> Sequence[float]:
        assert way > 0
        scale = 4.0 * wrap(m - x[1]) / (4 * (epsilon_2 - 1e-4) * x[0] ** 2)
        return cos(m) + copysign(1, sin(m)) * scale, -sin(m) / x[0] + epsilon_2 / 1e-2 * scale

    return rates


def luenberger(x: Array, m: float, way: float) -> Sequence[float]:
    """(20) with p = (64, 16), p₂ → −p₂ in z backwards, and |sin φ̂| ≥ 0.2 in the division."""
    r, φ, error = x[0], x[1], wrap(m - x[1])
    floored = copysign(max(abs(sin(φ)), 0.2), sin(φ))
    k1, k2 = 64 * r**2 / floored - sin(φ), way * 16 + 2 * cos(φ) / r
    return cos(φ) + k1 * error, -sin(φ) / r + k2 * error


def kalman(x: Array, m: float, way: float) -> Sequence[float]:
    """(18) and (19) as Kalman–Bucy, Q = diag(1e3, 0.2), R = 1e-3."""
    assert way > 0
    r, φ = x[:2]
    P = np.array(((x[2], x[3]), (x[3], x[4])))
    F = np.array(((0.0, -sin(φ)), (sin(φ) / r**2, -cos(φ) / r)))
    K = P[:, 1] / 1e-3
    dP = F @ P + P @ F.T + np.diag((1e3, 0.2)) - np.outer(K, P[1])
    dr, dφ = np.array((cos(φ), -sin(φ) / r)) + K * wrap(m - φ)
    return dr, dφ, dP[0, 0], dP[0, 1], dP[1, 1]


def bearing(pose: Array, landmark: tuple[float, float]) -> float:
    """φ = wrap(θ − ψ)."""
    return wrap(pose[2] - float(np.arctan2(pose[1] - landmark[1], pose[0] - landmark[0])))


def full_state(a: Array, b: Array, φ: Sequence[float]) -> tuple[Place, float]:
    """(8) as mended: pose and l from r_A, r_B and both angles."""
    along, across = (a[0] * b[0] * f(φ[1] - φ[0]) for f in (cos, sin))
    l = (a[0] ** 2 + b[0] ** 2 - 2 * along) ** 0.5  # noqa: E741
    x, y = across / l, (a[0] ** 2 - along) / l
    return (x, y, wrap(φ[0] + float(np.arctan2(y, x)))), l


def observed(law: Law, x: Array, φ: tuple[float, float], u: float, way: float) -> Array:
    """An observer's state over one cycle, in which the measured φ goes straight from one to the other."""
    change = wrap(φ[1] - φ[0]) / (way * 1e-3)

    def rates(x: Array, z: float) -> Sequence[float]:
        dr, dφ, *dP = law(x, φ[0] + change * z, way)
        return dr, dφ + u, *dP

    return integrated(rates, x, way * 1e-3)


def seen(law: Law, start: Place, cycles: int, reverse: bool = False, P0: Sequence[float] = ()) -> Expected:
    """Straight on, or backwards along y = 1.5 by (21) with F₁ = −4 and, in z, F₂ = ±4.

    F₂ is +4 where x falls, as in Fig. 5, and −4 where it grows, which the first estimate makes believe.
    """
    way = -1.0 if reverse else 1.0
    pose = np.array(start)
    φ = [bearing(pose, landmark) for landmark in LANDMARKS]
    states = [np.array((r, angle, *P0)) for r, angle in zip(GUESSED, φ, strict=True)]
    rows = []
    for _ in range(cycles + 1):
        believed, l = full_state(*states, [x[1] for x in states] if P0 else φ)  # noqa: E741
        rows.append((pose, believed, l))
        u = 0.0
        if reverse:
            θ = believed[2]
            u = cos(θ) ** 3 * (-4.0 * (believed[1] - 1.5) + copysign(4.0, cos(θ)) * tan(θ))
        pose = held(pose, way, way * u, 1e-3)
        before, φ = φ, [bearing(pose, landmark) for landmark in LANDMARKS]
        states = [
            observed(law, x, pair, u, way)
            for x, pair in zip(states, zip(before, φ, strict=True), strict=True)
        ]
    truth, estimate, distance = zip(*rows, strict=True)
    return Expected(np.array(truth), np.array(estimate), np.array(distance))


# Pliego-Jiménez (2023)

GAIN, SPEED = 5.0, 0.3


def rotation(yaw: float) -> Array:
    """R of an angle."""
    return np.array(((cos(yaw), -sin(yaw)), (sin(yaw), cos(yaw))))


def so2_rates(x: Array, _: float) -> Sequence[float]:
    """R̂' = Ω R̂ S, Ω = ω + α vᵀ S v̂, v̂ = ν R̂ e₁; v is the velocity of the measured position."""
    R, v = x[3:].reshape(2, 2), SPEED * rotation(x[2])[:, 0]
    Ω = 0.3 + GAIN * v @ S @ (SPEED * R[:, 0])
    return (*v, 0.3, *(Ω * R @ S).ravel())


def s1_rates(x: Array, _: float) -> Sequence[float]:
    """Θ̂' = Ω S Θ̂ with the same Ω."""
    v = SPEED * rotation(x[2])[:, 0]
    Ω = 0.3 + GAIN * v @ S @ (SPEED * x[3:])
    return (*v, 0.3, *(Ω * S @ x[3:]))


def global_rates(x: Array, _: float) -> Sequence[float]:
    """ξ' = ω S Θ̄ − g ν² Θ̄ − g ν' p, Θ̄ = ξ + g ν p; here ν' = 0."""
    v = SPEED * rotation(x[2])[:, 0]
    Θ = x[3:] + GAIN * SPEED * x[:2]
    return (*v, 0.3, *(0.3 * S @ Θ - GAIN * SPEED**2 * Θ))


P0, R0 = np.array((0.0, -1.0)), rotation(-2.5)
HEADINGS: dict[str, tuple[Rates, Array, Callable[[Array], Array]]] = {
    "so2": (so2_rates, R0.ravel(), lambda x: x[:, (3, 5)]),
    "s1": (s1_rates, R0[:, 0], lambda x: x[:, 3:]),
    "global": (global_rates, R0[:, 0] - GAIN * SPEED * P0, lambda x: x[:, 3:] + GAIN * SPEED * x[:, :2]),
}
"""By the form: its equations, its start, and the heading in its states."""


def heading_observed(form: str) -> Expected:
    """On a circle of 1 m from (0, −1, 0) at 0.3 m/s, first guess 2.5 rad behind."""
    rates, start, heading = HEADINGS[form]
    x = odeint(rates, (*P0, 0.0, *start), np.arange(3001) * 0.01, rtol=1e-11, atol=1e-12)
    return Expected(x[:, :3], np.column_stack((x[:, :2], np.arctan2(*heading(x).T[::-1]))))


def on_circle(t: float) -> tuple[Place, float]:
    """Pose and turn rate (rad/s) of the reference of 1 m at 0.3 m/s."""
    a = 0.3 * t
    return (sin(a), -cos(a), a), 0.3


def on_eight(t: float) -> tuple[Place, float]:
    """Two circles of 0.8 m that touch at the origin, the left one first."""
    whole = 2 * pi * 0.8
    side = 1 if (0.3 * t) % (2 * whole) < whole else -1
    a = 0.3 * t % whole / 0.8
    return (0.8 * sin(a), side * 0.8 * (1 - cos(a)), side * a), side * 0.3 / 0.8


def tracked(reference: Callable[[float], tuple[Place, float]]) -> Expected:
    """(ν, ω) = diag(1, 1/δ) R̂ᵀ (ż_d − k (z − z_d)), δ = 0.1 m, k = 1/s, observer on SO(2), α = 20."""
    x, rows = np.array((0.3, -1.2, -0.6, -0.6 - 2.5)), []
    for k in range(4001):
        rows.append(x)
        (px, py, course), w = reference(0.01 * k)
        ahead, R = rotation(course), rotation(x[3])
        z = x[:2] + 0.1 * rotation(x[2])[:, 0]  # measured, by a marker
        wanted = ahead @ (0.3, 0.1 * w) - (z - (px, py) - 0.1 * ahead[:, 0])
        v, aside = R.T @ wanted
        x = integrated(loop_rates(v, aside / 0.1), x, 0.01)
    found = np.array(rows)
    return Expected(found[:, :3], found[:, (0, 1, 3)])


def loop_rates(v: float, w: float) -> Rates:
    """The unicycle and θ̂' = Ω = ω + α ν² sin(θ − θ̂)."""
    return lambda x, _: (v * cos(x[2]), v * sin(x[2]), w, w + 20.0 * v * v * sin(x[2] - x[3]))


AHEAD, BACK = (1.0, 2.0, -0.5), (3.0, 1.0, -0.8)

ORACLES: dict[str, Callable[[], Expected]] = {
    **{f"bui2022/test{n}-type{kind}": partial(ramped, n, kind) for n in (1, 2, 3) for kind in (1, 2)},
    "bui2022/open-loop": partial(on_legs, (-20.0, 4.0, 0.0), closed=False),
    "bui2022/closed-loop": partial(on_legs, (-20.0, 3.0, 0.0), closed=True),
    "ishikawa1994/estimation-lyapunov": partial(seen, lyapunov(2.0e-3), AHEAD, 3000),
    "ishikawa1994/estimation-lyapunov-mended": partial(seen, lyapunov(2.0e-4), AHEAD, 3000),
    "ishikawa1994/estimation-elo": partial(seen, luenberger, AHEAD, 3000),
    "ishikawa1994/estimation-ekf": partial(seen, kalman, AHEAD, 3000, P0=(1.0, 0.0, 0.1)),
    "ishikawa1994/reverse": partial(seen, luenberger, BACK, 5000, reverse=True),
    **{f"pliego2023/observer-{form}": partial(heading_observed, form) for form in HEADINGS},
    "pliego2023/circle": partial(tracked, on_circle),
    "pliego2023/eight": partial(tracked, on_eight),
}
"""By the scenario's name."""
