"""What the models of all scenario parts share: strict, frozen, and with limits that say their units."""

from __future__ import annotations

from typing import Annotated, Any, TypeVar

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

T = TypeVar("T")

LARGEST = 1e9
"""No quantity of a bench is larger, in SI units; beyond it squares of squares would run over."""

Finite = Annotated[float, Field(ge=-LARGEST, le=LARGEST, allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, le=LARGEST, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0, le=LARGEST, allow_inf_nan=False)]
Fraction = Annotated[float, Field(ge=0, le=1)]
Listed = Annotated[T, Field(strict=False)]
"""A tuple, which YAML writes as a list."""

Point = Listed[tuple[Finite, Finite]]


def _word(value: Any) -> Any:
    return {"kind": value} if isinstance(value, str) else value


Word = BeforeValidator(_word)
"""On a block: a word is short for a block of that kind, `controller: open_loop`."""


class Spec(BaseModel):
    """One block of a scenario: unknown keys are errors, values are fixed once read.

    Types are what they say: neither "1" nor true is a number.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)
