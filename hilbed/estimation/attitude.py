"""The heading of a wheeled robot from how its position moves: the observers of Pliego-Jiménez (2023).

A plane vector is a complex number here: Θ = exp(iθ) is the unit heading vector, S the factor i. Between two
measured positions speed ν and yaw rate ω are known from odometry, so the observers' equations have exact
solutions, which these are: no step is too long.
"""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Sequence
from math import atan2, cos, exp, sin
from typing import NamedTuple

import numpy as np

from hilbed.chords import chord
from hilbed.clock import seconds
from hilbed.estimation.ways import Way
from hilbed.types import Array

NOWHERE = 1e-6  # m: a robot that has not moved further shows no heading


class Motion(NamedTuple):
    """What odometry says of the way between two positions, and what was measured.

    displacement: end − start (m) if the heading at the start were 0; turn (rad); energy: ∫ν² dt (m²/s);
    measured: end − start in the map (m).
    """

    displacement: complex
    turn: float
    energy: float
    measured: complex


STILL = Motion(0j, 0.0, 0.0, 0j)


def extended(motion: Motion, way: Way) -> Motion:
    """Returns a motion with an odometry increment, an arc, at its end."""
    length, direction = chord(way.distance, way.turn)
    return Motion(
        motion.displacement + rect(length, motion.turn + direction),
        motion.turn + way.turn,
        motion.energy + way.distance**2 / seconds(way.end - way.start),
        motion.measured,
    )


def through(ways: Sequence[Way]) -> Motion:
    """Returns the motion over increments."""
    motion = STILL
    for way in ways:
        motion = extended(motion, way)
    return motion


def seen_heading(motion: Motion) -> complex | None:
    """Returns Θ at the start as the positions show it, |Θ| as far as they disagree with odometry.

    None where the robot has stood. The sign of ν is in the displacement, so it holds backwards.
    """
    if abs(motion.displacement) < NOWHERE:
        return None
    return motion.measured / motion.displacement


def decayed(error: float, exponent: float) -> float:
    """Returns e(t) of ė = −a sin e: tan(e/2) = tan(e₀/2) exp(−∫a); ±π stays (rad)."""
    return 2.0 * atan2(exp(-exponent) * sin(0.5 * error), cos(0.5 * error))


def rotation(heading: complex, motion: Motion, alpha: float) -> float:
    """Returns ∫Ω dt (rad) of Ω = ω + α vᵀ S v̂, v̂ = ν R̂ e₁, over a motion; alpha in s/m² · rad.

    vᵀ S v̂ = ν² sin e with e = θ − θ̂, so that the error decays and the rotation is the turn and what it lost.
    """
    seen = seen_heading(motion)
    if seen is None:
        return motion.turn
    error = phase(seen / heading) if seen else 0.0
    return motion.turn + error - decayed(error, alpha * abs(seen) * motion.energy)


def so2_step(R: Array, motion: Motion, alpha: float) -> Array:
    """Returns R̂ (2, 2) of R̂' = Ω R̂ S after a motion, by the exponential: R̂ exp(S ∫Ω) stays a rotation."""
    a = rotation(complex(R[0, 0], R[1, 0]), motion, alpha)
    stepped: Array = R @ np.array(((cos(a), -sin(a)), (sin(a), cos(a))))
    return stepped


def s1_step(heading: complex, motion: Motion, alpha: float) -> complex:
    """Returns Θ̂ of Θ̂' = Ω S Θ̂ on the unit circle after a motion."""
    turned = heading * rect(1.0, rotation(heading, motion, alpha))
    return turned / abs(turned)


def global_step(heading: complex, motion: Motion, g: float) -> complex:
    """Returns Θ̄, which is not of unit length, after a motion: |Θ̃| = |Θ̃₀| exp(−g ∫ν²); g in s/m².

    Θ̄ = ξ + g ν p with ξ' = ω S Θ̄ − g ν² Θ̄ − g ν' p. While ν is held ν' is zero; where it jumps ξ jumps by
    −g p Δν, so Θ̄ does not: ξ need not be kept, and ν' is not dropped.
    """
    turned = rect(1.0, motion.turn)
    seen = seen_heading(motion)
    if seen is None:
        return turned * heading
    q = exp(-g * motion.energy)
    return turned * (q * heading + (1.0 - q) * seen)
