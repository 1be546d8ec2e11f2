"""What drawings work out of a run: closed forms, sights, the chosen control."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hilbed.control.cloud_spec import CloudSpec
from hilbed.criteria import Missing, Signals
from hilbed.estimation.sights import sight
from hilbed.paper.catalogue import Figure
from hilbed.paper.drawings import bearings, clouds, drawers, headings
from hilbed.report import cloud_figures, style
from hilbed.report.run import Run
from hilbed.types import Pose

T = np.arange(0.0, 3.0, 0.01)


def run_of(scenario: str, **signals: np.ndarray) -> Run:
    return Run(Path(), scenario, {}, Signals(signals), (), (), ())


def turned(form: str, error: float) -> Run:
    """A run whose estimate follows the observer's differential equation, integrated by scipy."""
    gain, v, w = 5.0, 0.4, 0.3

    def so2(_: float, e: np.ndarray) -> np.ndarray:
        return np.asarray(-gain * v**2 * np.sin(e))

    def free(_: float, Θ: np.ndarray) -> np.ndarray:
        """Θ̄' of a robot that turns with w: ω S Θ̄ + g ν² (Θ − Θ̄), in the robot's frame, where Θ = (1, 0)."""
        return np.asarray(gain * v**2 * (np.array((1.0, 0.0)) - Θ))

    if form == "global":
        start = [np.cos(error), np.sin(error)]
        x, y = solve_ivp(free, (0, 3), start, t_eval=T, rtol=1e-10, atol=1e-12).y
        e = np.arctan2(y, x)
    else:
        e = solve_ivp(so2, (0, 3), [error], t_eval=T, rtol=1e-10, atol=1e-12).y[0]
    truth = np.column_stack((T, T, w * T))
    estimate = truth + np.column_stack((0 * T, 0 * T, e))
    command = np.column_stack((np.full(len(T), v), np.full(len(T), w)))
    text = f"estimator: {{kind: attitude, form: {form}, gain: {gain}, heading_error: {-error}}}"
    return run_of(text, t=T, truth=truth, estimate=estimate, command=command)


@pytest.mark.parametrize("form", ["so2", "s1", "global"])
@pytest.mark.parametrize("error", [-3.1, -0.5, 1.0, 2.5])
def test_the_law_is_the_solution_of_the_observers_equation(form: str, error: float) -> None:
    assert headings.departure(turned(form, error)) < 1e-7


def test_a_fan_tells_how_far_each_run_departs_from_the_law() -> None:
    run = turned("so2", 2.0)
    run.signals["estimate"][150, 2] += 0.25
    with style.drawing():
        text = headings.fan({"2": run}, figure("fan"))
    assert text is not None
    numbers = re.findall(r'<td class="number">([^<]*)<', text)
    assert numbers[0] == numbers[1]
    assert float(numbers[2]) == pytest.approx(0.25, abs=1e-3)


def test_sights_are_those_of_the_observers() -> None:
    states = np.array([(1.0, 2.0, -0.5, 1.0), (-2.0, 0.3, 3.0, 1.5)])
    for (x, y, yaw, l), row in zip(states.tolist(), bearings.polar(states), strict=True):  # noqa: E741
        expected = [*sight(Pose(x, y, yaw), (0.0, 0.0)), *sight(Pose(x, y, yaw), (0.0, l))]
        assert row == pytest.approx(expected)


def cloudy() -> Run:
    rng = np.random.default_rng(3)
    particles = rng.normal((3.0, 1.0, 2.0), 0.3, (2, 200, 3))
    law = CloudSpec().model_dump(mode="json")
    reference = np.tile((1.0, 3.0, -np.pi / 2), (5, 1))
    truth = np.tile((3.0, 1.0, 2.0), (5, 1))
    return run_of(
        f"controller: {law}",
        **{
            "t": 0.05 * np.arange(5),
            "truth": truth,
            "estimate": truth,
            "reference": reference,
            "cloud/t": np.array([0.0, 0.15]),
            "cloud/particles": particles,
        },
    )


def test_the_chosen_control_has_the_most_neighbours() -> None:
    run = cloudy()
    u1, u2, best = clouds.control_cloud(run, 0.15)
    radii = CloudSpec().radii
    x, y = u1 / radii[0], u2 / radii[1]
    support = np.count_nonzero((x[:, None] - x) ** 2 + (y[:, None] - y) ** 2 < 1, axis=1)
    assert best == int(np.argmax(support))


def test_an_instant_without_a_cloud_is_told() -> None:
    assert np.array_equal(cloud_figures.cloud_at(cloudy(), 0.15), cloudy().signals["cloud/particles"][1])
    with pytest.raises(Missing, match=r"no cloud was recorded at 0\.1 s"):
        cloud_figures.cloud_at(cloudy(), 0.1)


def test_every_cloud_drawing_shows_every_particle() -> None:
    with style.drawing():
        for word, axes in (("belief", 2), ("controls", 1)):
            text = drawers()[word]({"single": cloudy()}, figure(word, at=0.15))
            assert text is not None
            assert text.count("<use") >= 200 * axes


def figure(word: str, **more: float) -> Figure:
    return Figure.model_validate({"caption": "c", "draw": word, "scenarios": ["demo"], **more})
