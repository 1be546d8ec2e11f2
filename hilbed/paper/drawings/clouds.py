"""Clouds of states and of controls: Lages & Alves (2017), Fig. 4 and 7 to 11."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
import yaml

from hilbed.control.cloud_spec import CloudSpec
from hilbed.control.stabilisation import Gains, stabilising, within_wheel_limit
from hilbed.control.support import most_supported
from hilbed.estimation.cloud import WayNoise, lattice, predicted
from hilbed.paper.catalogue import Figure
from hilbed.paper.drawings import Runs, first
from hilbed.paper.drawings.overlays import COLOURS
from hilbed.report import cloud_figures, style
from hilbed.report.run import Run
from hilbed.rng import stream
from hilbed.types import Command, Pose

SHOWN, U1, U2, STEPS = 50, 2.0, 0.8, 3
"""Fig. 4: so many particles at the origin, its input in m/s and rad/s, its steps."""


def prediction(runs: Runs, _: Figure) -> str | None:
    """Returns three steps of prediction, with the noise and the period of the run's scenario."""
    scenario = yaml.safe_load(first(runs).scenario)
    noise = WayNoise(scenario["estimator"]["along_noise"], scenario["estimator"]["turn_noise"])
    T, rng = scenario["period"], stream(scenario["seed"], "prediction")
    cloud = lattice(Pose(0.0, 0.0, 0.0), SHOWN, 0.0)
    figure, (axes,) = style.sheet(1, 3.0)
    for k in range(STEPS + 1):
        x, y, yaw = cloud.T
        colour = style.STAND_IN[COLOURS[k]]
        axes.quiver(x, y, np.cos(yaw), np.sin(yaw), color=colour, scale=30, width=0.0025, label=f"k = {k}")
        cloud = predicted(cloud, T * U1, T * U2, noise, rng)
    axes.set_xlabel("x  [m]")
    axes.set_ylabel("y  [m]")
    axes.set_xlim(-0.02, 0.36)
    style.legend(axes, 2.0)
    return style.svg(figure, "prediction of a cloud")


def belief(runs: Runs, figure: Figure) -> str | None:
    """Returns the cloud of poses at an instant in the plane, and x over yaw."""
    return cloud_figures.belief(first(runs), figure.at)


def controls(runs: Runs, figure: Figure) -> str | None:
    """Returns the cloud of controls at an instant, the chosen one and what the wheels' limits leave of it."""
    run = first(runs)
    u1, u2, best = control_cloud(run, figure.at)
    law = _law(run)
    sheet, (axes,) = style.sheet(1, 3.2)
    axes.plot(u1, u2, ".", markersize=3, color=style.STAND_IN["estimate"], label="one a particle")
    a = np.linspace(0.0, 2 * pi, 100)
    ring = u1[best] + law.radii[0] * np.cos(a), u2[best] + law.radii[1] * np.sin(a)
    axes.plot(*ring, color=style.STAND_IN["odometry"], label="its support")
    axes.plot(u1[best], u2[best], "o", markersize=5, color=style.STAND_IN["bad"], label="chosen")
    chosen = Command(float(u1[best]), float(u2[best]))
    applied = within_wheel_limit(chosen, law.half_track, law.wheel_speed)
    axes.plot(*applied, "x", markersize=6, color=style.STAND_IN["truth"], label="applied")
    axes.set_xlabel("u₁  [m/s]")
    axes.set_ylabel("u₂  [rad/s]")
    style.legend(axes, 2.0)
    return style.svg(sheet, f"controls at {figure.at:g} s")


def control_cloud(run: Run, t: float) -> tuple[np.ndarray, np.ndarray, int]:
    """Returns u₁ (M,) in m/s and u₂ (M,) in rad/s of the cloud recorded at `t`, and which one is chosen."""
    law = _law(run)
    goal = Pose(*run.signals["reference"][0].tolist())
    gains = Gains(law.gamma_1, law.gamma_2, law.h, law.guard)
    u1, u2 = stabilising(cloud_figures.cloud_at(run, t), goal, gains)
    return u1, u2, most_supported(u1 / law.radii[0], u2 / law.radii[1])


def _law(run: Run) -> CloudSpec:
    block: dict[str, Any] = yaml.safe_load(run.scenario)["controller"]
    return CloudSpec.model_validate(block)
