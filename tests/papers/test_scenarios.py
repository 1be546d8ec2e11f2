"""The papers' ideal experiments as scenarios: through the bench's own cycle, beside the equations."""

from __future__ import annotations

from math import tan

import numpy as np
import pytest

from hilbed.criteria.pose import turned
from hilbed.criteria.signals import Signals
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
