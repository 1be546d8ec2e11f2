"""Twins on the bench: each ideal experiment has one, of the same robot, with a path and chance of its own.

All of them over 20 seeds: `python scripts/twins.py`.
"""

from __future__ import annotations

import numpy as np
import pytest

from hilbed.disturbances.bodies import SlipPatch
from hilbed.scenario import bundled
from hilbed.scenario.load import load
from hilbed.scenario.model import Scenario
from tests.bench import ran
from tests.papers.test_scenarios import IDEAL

VARIANTS = ("-printed", "-mended")
NAMES = [name for name in IDEAL if not name.endswith(VARIANTS)]
TWINS = [name for name in bundled.names() if name.endswith("-bench")]
PATH = ("reference_distance", "cross_track", "turning_radius")
FEW = {
    "bui2022/test3-type2-bench": 10,
    "ishikawa1994/reverse-bench": 4,
    "lages2017/start-4-bench": 30,
    "pliego2023/observer-global-bench": 30,
}
"""By name, with the time (s) after which they can be judged."""


def scenario(name: str, seed: int | None = None) -> Scenario:
    return load(name, seed=seed).scenario


@pytest.mark.parametrize("name", NAMES)
def test_every_ideal_experiment_has_a_twin_of_the_same_robot(name: str) -> None:
    """DESIGN.md, section 6: wheelbase, track and wheel radius are shared; so are start and limits here."""
    ideal, twin = scenario(name), scenario(f"{name}-bench")
    assert twin.plant.kind == "bullet"
    assert twin.robot == ideal.robot
    assert twin.estimator.kind == ideal.estimator.kind or ideal.estimator.kind == "measured"
    assert twin.controller is not None
    assert ideal.controller is not None
    assert twin.controller.kind == ideal.controller.kind


@pytest.mark.parametrize("name", TWINS)
def test_no_twin_is_alone(name: str) -> None:
    assert name.removesuffix("-bench") in IDEAL


@pytest.mark.parametrize("name", [name for name in TWINS if name.startswith("pliego2023/")])
def test_the_twins_of_pliego2023_drive_the_robot_of_slimane2014(name: str) -> None:
    theirs = scenario("slimane2014/tracking-circle").robot
    assert scenario(name).robot.model_copy(update={"start": theirs.start}) == theirs


@pytest.mark.parametrize("name", TWINS)
def test_it_states_how_far_it_may_leave_its_path(name: str) -> None:
    criteria = scenario(name).criteria.items()
    assert any((c.metric or key).startswith(PATH) and c.max is not None for key, c in criteria)


@pytest.mark.parametrize("name", TWINS)
def test_something_about_it_is_chance(name: str) -> None:
    assert any(
        getattr(disturbance, "spread", 0) or disturbance.kind == "command_noise"
        for disturbance in scenario(name).disturbances
    )


@pytest.mark.parametrize("name", TWINS)
def test_slippery_ground_lies_on_the_way(name: str) -> None:
    """On that of the ideal run, for half a second at least."""
    path, patches = ran(name.removesuffix("-bench")).signals, scenario(name).disturbances
    for patch in [one for one in patches if isinstance(one, SlipPatch)]:
        low, high = np.sort([patch.corner, patch.opposite], axis=0)
        inside = ((path["truth"][:, :2] > low) & (path["truth"][:, :2] < high)).all(axis=1)
        assert np.ptp(path["t"][inside]) > 0.5


@pytest.mark.parametrize("name", FEW)
def test_few_seeds_of_few_twins_are_different_experiments_that_all_pass(name: str) -> None:
    runs = [ran(name, f"duration={FEW[name]}", seed=seed).verdict for seed in (2, 3)]
    assert [run["reason"] for run in runs] == ["", ""]
    first, second = ({key: body["value"] for key, body in run["criteria"].items()} for run in runs)
    assert all(first[key] != second[key] for key in first)
