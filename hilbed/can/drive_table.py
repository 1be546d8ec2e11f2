"""What there is to know about a type of drive, as data: one YAML file in `tables/` for each type."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Annotated

import yaml
from pydantic import Field, ValidationError, model_validator

from hilbed.can.codec import DataType, PdoCodec, bit_length
from hilbed.can.units import Units
from hilbed.spec import Finite, Spec
from hilbed.types import ScenarioError

TABLES = Path(__file__).parent / "tables"
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast where libyaml is there
PdoName = Annotated[str, Field(pattern="^[rt]pdo[1-4]$")]
U8 = Annotated[int, Field(ge=0, le=0xFF)]
U16 = Annotated[int, Field(ge=0, le=0xFFFF)]
U32 = Annotated[int, Field(ge=0, le=0xFFFFFFFF)]


class Entry(Spec):
    """An entry of the object dictionary."""

    index: U16
    sub: U8 = 0
    type: DataType


class Write(Entry):
    """A value that is written at boot."""

    value: Finite


class Setting(Entry):
    """Where a number or a word of the scenario goes: number × scale, or what the word stands for."""

    scale: Finite = 1.0
    words: dict[str, int] = Field(default_factory=dict)

    def raw(self, value: float | str) -> float:
        """Returns what is written for a value in SI units or a word; KeyError for an unknown word."""
        return self.words[value] if isinstance(value, str) else value * self.scale


class Pdo(Spec):
    """A PDO: base of its identifier, transmission type, event timer in ms (0: none), names of objects."""

    cob_id: U16
    transmission: U8 = 1
    event_timer: U16 = 0
    map: list[str]


class Identity(Spec):
    """What 1000 and 1018:01, 1018:02 must say."""

    device_type: U32
    vendor: U32
    product: U32


class Heartbeat(Spec):
    """ms: how often drive and controller say that they live, and after which silence the drive stops."""

    drive: Annotated[int, Field(ge=1, le=0xFFFF)] = 100
    controller: Annotated[int, Field(ge=1, le=0xFFFF)] = 50
    consumer: Annotated[int, Field(ge=1, le=0xFFFF)] = 250


class DriveTable(Spec):
    """A type of drive: identity, units, objects, PDOs, modes, what is written at boot, where settings go.

    remappable: whether the mapping of its PDOs may be written; interpolates: whether it has 60C2;
    writes: as they stand; period: objects that follow from the control period (s); settings: objects that
    follow from words and numbers of the scenario.
    """

    name: str
    identity: Identity
    units: Units
    objects: dict[str, Entry]
    pdos: dict[PdoName, Pdo]
    remappable: bool = True
    interpolates: bool = False
    modes: dict[str, int]
    heartbeat: Heartbeat = Heartbeat()
    writes: list[Write] = Field(default_factory=list)
    period: list[Setting] = Field(default_factory=list)
    settings: dict[str, Setting] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _mapped(self) -> DriveTable:
        for name, pdo in self.pdos.items():
            unknown = [word for word in pdo.map if word not in self.objects]
            if unknown:
                raise ValueError(f"{name} maps {unknown[0]!r}, which is not among the objects")
            if sum(bit_length(self.objects[word].type) for word in pdo.map) > 64:
                raise ValueError(f"{name} is longer than 8 bytes")
        sent = {word for name, pdo in self.pdos.items() if name[0] == "t" for word in pdo.map}
        for word in ("statusword", "velocity_actual", "position_actual"):
            if word not in sent:
                raise ValueError(f"no TPDO maps {word}")
        if "rpdo1" not in self.pdos or {*self.pdos["rpdo1"].map} != {"controlword", "target_velocity"}:
            raise ValueError("rpdo1 must map controlword and target_velocity")
        return self

    def codec(self, pdo: str) -> PdoCodec:
        """Returns the compiled mapping of a PDO by its name."""
        return PdoCodec([(word, self.objects[word].type) for word in self.pdos[pdo].map])


def bundled_tables() -> list[str]:
    """Returns the names of the drive types that come with hilbed."""
    return sorted(path.stem for path in TABLES.glob("*.yaml"))


@cache
def load_table(name: str) -> DriveTable:
    """Returns a bundled table by name; ScenarioError where there is none."""
    if name not in bundled_tables():
        raise ScenarioError(f"no drive table {name!r}; there are: {', '.join(bundled_tables())}")
    return read_table(TABLES / f"{name}.yaml")


def read_table(path: Path) -> DriveTable:
    """Reads a table's file; ScenarioError with the file and all that is wrong in it."""
    try:
        return DriveTable.model_validate(yaml.load(path.read_text(encoding="utf-8"), _LOADER))
    except (OSError, yaml.YAMLError) as error:
        raise ScenarioError(f"{path}: {error}") from error
    except ValidationError as error:
        raise ScenarioError(
            "\n".join(f"{path}: {'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors())
        ) from error
