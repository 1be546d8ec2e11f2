"""From a scenario to a bench: the only part that knows every concrete class."""

from __future__ import annotations

from hilbed.build.bench import BOOT, Bench
from hilbed.cost import Cost
from hilbed.ports import Witness
from hilbed.scenario.load import Loaded

__all__ = ["BOOT", "Bench", "build"]


def build(loaded: Loaded, witness: Witness, cost: Cost) -> Bench:
    """Returns the bench of a scenario; raises ScenarioError for what only building it can find."""
    from hilbed.build.recorded import recorded
    from hilbed.build.simulated import simulated

    builders = {"bullet": simulated, "recorded": recorded}
    return builders[loaded.scenario.plant.kind](loaded, witness, cost)
