"""The gear between motor and wheel: a ratio, and losses that depend on who drives whom."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from hilbed.spec import NonNegative, Positive, Spec

# Speed of the wheel (rad/s) within which the losses fade to nothing: at rest friction may take any value
# between driving and being driven, and a jump between the two would chatter at the tick.
EDGE = 0.1

Efficiency = Annotated[float, Field(gt=0, le=1)]


class GearSpec(Spec):
    """A gear of `ratio` motor turns a wheel turn.

    efficiency: power out / power in when the motor drives; back_efficiency: when the wheel drives;
    inertia kg m² at the motor's shaft.
    """

    ratio: Positive
    efficiency: Efficiency = 1.0
    back_efficiency: Efficiency = 1.0
    inertia: NonNegative = 0.0
    source: str = ""


GEARS = {
    "gp32c-33": GearSpec(
        # 529:16, sold as 33:1.
        ratio=33.0,
        efficiency=0.75,
        # Not in the sheet: the same loss of torque at the teeth both ways gives 2 − 1/η (Niemann & Winter,
        # Maschinenelemente 2).
        back_efficiency=0.667,
        inertia=0.8e-7,
        source="maxon GP 32 C planetary, two stages, 33:1, order number 166163, data sheet: "
        "75 %, 3 N m continuous, 3.75 N m intermittent",
    ),
}


def _by_name(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    if value not in GEARS:
        raise ValueError(f"no gear '{value}' in the catalogue; there are {', '.join(GEARS)}, or give a block")
    return GEARS[value]


Gear = Annotated[GearSpec, BeforeValidator(_by_name)]


def transmitted(driving_loss: float, driven_gain: float, along: float) -> float:
    """Returns wheel torque / (ratio × shaft torque) for a wheel turning `along` (rad/s) that torque.

    driving_loss: 1 − efficiency; driven_gain: 1 / back_efficiency − 1. Positive `along`: the motor drives
    and loses torque in the teeth; negative: the wheel drives and the teeth help to hold it.
    """
    if along >= EDGE:
        return 1.0 - driving_loss
    if along <= -EDGE:
        return 1.0 + driven_gain
    return 1.0 - (driving_loss if along > 0.0 else driven_gain) * along / EDGE
