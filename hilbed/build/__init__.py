"""From a scenario to a bench: the only part that knows every concrete class."""

from __future__ import annotations

from collections.abc import Callable

from hilbed.build.bench import BOOT, Bench
from hilbed.cost import Cost
from hilbed.pacer import Pacer
from hilbed.ports import Witness
from hilbed.scenario.load import Loaded

__all__ = ["BOOT", "Bench", "build"]


def build(
    loaded: Loaded, witness: Witness, cost: Cost, separate: bool = False, pacer: Pacer | None = None
) -> Bench:
    """Returns the bench of a scenario; raises ScenarioError for what only building it can find.

    separate: cameras render in processes of their own, to the same hash; pacer: of a run in real time.
    """
    from hilbed.build.ideal import ideal
    from hilbed.build.recorded import recorded
    from hilbed.build.simulated import simulated

    builders: dict[str, Callable[..., Bench]] = {
        "bullet": simulated, "recorded": recorded, "kinematic": ideal,
    }  # fmt: skip
    return builders[loaded.scenario.plant.kind](loaded, witness, cost, separate, pacer)
