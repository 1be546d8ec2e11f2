"""The speed reference on its way to a target."""

from __future__ import annotations

from math import inf


def approach(value: float, target: float, rise: float, fall: float) -> float:
    """Returns the reference one tick later.

    rise, fall: largest change a tick while the speed grows or shrinks; a reversal brakes first.
    """
    goal = target if target * value >= 0.0 or fall == inf else 0.0
    step = rise if abs(goal) > abs(value) else fall
    if goal > value:
        return min(goal, value + step)
    return max(goal, value - step)
