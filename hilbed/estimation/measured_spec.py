"""Scenario block of state feedback."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from hilbed.spec import Spec


class MeasuredSpec(Spec):
    """The pose as a sensor gives it; memory (s): how old a reading may be."""

    kind: Literal["measured"] = "measured"
    memory: Annotated[float, Field(gt=0, le=60)] = 1.0
