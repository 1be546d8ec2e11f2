"""Every ideal experiment beside scipy to 1e-6: from its equations; a noisy one, given what noise it drew."""

from __future__ import annotations

from math import pi, tan

import numpy as np
import pytest

from hilbed.rng import stream
from hilbed.scenario.load import load
from hilbed.types import Array
from tests.bench import ran
from tests.papers.oracles import ORACLES, held
from tests.papers.test_scenarios import IDEAL

NOISY = [name for name in IDEAL if name not in ORACLES]
SHORT = 10  # s of the noisy ones


def off(ours: Array, theirs: Array) -> float:
    """The largest difference of poses (N, 3), yaw modulo 2π."""
    difference = ours - theirs
    difference[:, 2] = (difference[:, 2] + pi) % (2 * pi) - pi
    return float(np.abs(difference).max())


@pytest.mark.parametrize("name", ORACLES)
def test_a_deterministic_run_is_the_papers_equations_integrated(name: str) -> None:
    expected, signals = ORACLES[name](), ran(name, "criteria={}").signals
    assert off(signals["truth"], expected.truth) < 1e-6
    assert off(signals["estimate"], expected.estimate) < 1e-6
    if expected.distance is not None:
        np.testing.assert_allclose(signals["landmark_distance"], expected.distance, atol=1e-6)


def test_what_has_no_oracle_is_noisy() -> None:
    for name in NOISY:
        plant = load(name).scenario.plant
        assert any(plant.command_noise + plant.twist_noise), name
    assert len(ORACLES) + len(NOISY) == 39


@pytest.mark.parametrize("name", NOISY)
def test_the_truth_of_a_noisy_run_is_its_commands_and_its_draws_integrated(name: str) -> None:
    """v cos γ … of the limited noisy command, then v + v w_t, ω + v w_D; one draw each a cycle, then held."""
    scenario = load(name).scenario
    T, chance = scenario.period, stream(scenario.seed, "plant")
    sigma = (*scenario.plant.command_noise, *scenario.plant.twist_noise)
    signals = ran(name, "criteria={}", f"duration={SHORT}").signals
    rows = [signals["truth"][0]]
    for command in signals["command"][:-1]:
        noise = [chance.normal(0.0, std) for std in sigma]
        v, w = (command + noise[:2]).tolist()
        if scenario.robot.kind == "tricycle":
            v, γ = min(max(v, -1.74), 1.74), min(max(w, -pi / 4), pi / 4)
            w = v * tan(γ)
        rows.append(held(rows[-1], v + v * noise[2], w + v * noise[3], T))
    assert off(signals["truth"], np.array(rows)) < 1e-6
