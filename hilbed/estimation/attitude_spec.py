"""Scenario block of the attitude observers of Pliego-Jiménez (2023)."""

from __future__ import annotations

from math import pi
from typing import Annotated, Literal

from pydantic import Field

from hilbed.spec import Positive, Spec


class AttitudeSpec(Spec):
    """form: on SO(2), on the unit circle, or global; gain: α or g, s/m² (free); memory: s.

    heading_error (rad): of the first guess, taken off the robot's heading at the start.
    """

    kind: Literal["attitude"] = "attitude"
    form: Literal["so2", "s1", "global"] = "so2"
    gain: Positive = 5.0
    heading_error: Annotated[float, Field(ge=-pi, le=pi)] = 0.0
    memory: Annotated[float, Field(gt=0, le=60)] = 1.0
