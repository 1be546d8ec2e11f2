"""Objects of a drive's dictionary as its table names them, of the whole node or of one of its axes."""

from __future__ import annotations

from typing import Annotated, Literal, NamedTuple

from pydantic import Field, model_validator

from hilbed.can.codec import DataType, bit_length
from hilbed.spec import Finite, Spec

U8 = Annotated[int, Field(ge=0, le=0xFF)]
U16 = Annotated[int, Field(ge=0, le=0xFFFF)]
U32 = Annotated[int, Field(ge=0, le=0xFFFFFFFF)]

_HALVES: dict[str, DataType] = {"u32": "u16", "i32": "i16"}


class Entry(Spec):
    """An entry of the object dictionary."""

    index: U16
    sub: U8 = 0
    type: DataType


class Object(Entry):
    """An entry that PDOs and SDOs of the bench know by a word.

    per_axis: how a node of several axes holds one value each: `sub` (axis k in the k-th sub-index from `sub`
    on), `half` (axis 1 in the lower, axis 2 in the upper half of one value); null: one value for all.
    """

    per_axis: Literal["sub", "half"] | None = None

    @model_validator(mode="after")
    def _halves(self) -> Object:
        if self.per_axis == "half" and self.type not in _HALVES:
            raise ValueError(f"halves of a {self.type}: only u32 and i32 are shared by two axes")
        return self

    def of(self, axis: int) -> Entry:
        """Returns the entry that holds the value of an axis (1, 2, …)."""
        sub = self.sub + axis - 1 if self.per_axis == "sub" else self.sub
        return Entry(index=self.index, sub=sub, type=self.type)

    def part(self, axis: int, value: int) -> int:
        """Returns the bits of an axis out of a value that was read from `of(axis)`."""
        if self.per_axis != "half":
            return value
        width = bit_length(self.type) // 2
        return value >> width * (axis - 1) & (1 << width) - 1

    def parts(self, axis: int) -> list[tuple[int, DataType]]:
        """Returns whose and of what type the values are that `of(axis)` holds; axis 0: of the whole node."""
        if self.per_axis == "half":
            return [(1, _HALVES[self.type]), (2, _HALVES[self.type])]
        return [(axis if self.per_axis == "sub" else 0, self.type)]


class Write(Entry):
    """A value that is written at boot."""

    value: Finite


class Setting(Object):
    """Where a number or a word of the scenario goes: number × scale, or what the word stands for."""

    scale: Finite = 1.0
    words: dict[str, int] = Field(default_factory=dict)

    def raw(self, value: float | str) -> float:
        """Returns what is written for a value in SI units or a word; KeyError for an unknown word."""
        return self.words[value] if isinstance(value, str) else value * self.scale


class Pdo(Spec):
    """A PDO: base of its identifier, transmission type, event timer in ms (0: none), words of objects.

    Of an object that every axis has in a sub-index of its own, the word names the axis: velocity_actual.2.
    """

    cob_id: U16
    transmission: U8 = 1
    event_timer: U16 = 0
    map: list[str]


class MappedValue(NamedTuple):
    """One value in a PDO: word of its object, axis (0: of the whole node), type."""

    word: str
    axis: int
    type: DataType
