"""What there is to know about a type of drive, as data: one YAML file in `tables/` for each type."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, lru_cache
from itertools import product
from pathlib import Path
from typing import Annotated, Any

import yaml
from pydantic import Field, ValidationError, model_validator

from hilbed import problems, yaml12
from hilbed.can.codec import PdoCodec, bit_length
from hilbed.can.objects import U32, Entry, MappedValue, Object, Pdo, Setting, Write
from hilbed.can.units import Units
from hilbed.problems import nearest, shorten
from hilbed.spec import Spec
from hilbed.types import ScenarioError

TABLES = Path(__file__).parent / "tables"
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast where libyaml is there
PdoName = Annotated[str, Field(pattern="^[rt]pdo[1-4]$")]
Milliseconds = Annotated[int, Field(ge=1, le=0xFFFF)]

OWN = "hilbed402"
"""The table of the bench's own drive."""

POSITION = "hilbed402-csp"
"""The table of the bench's own drive as one that holds a position."""

PROFILE = "hilbed402-pp"
"""The same for one that is given set-points."""

TARGETS = ("target_velocity", "target_position")
MEASURED = ("statusword", "velocity_actual", "position_actual")


class Identity(Spec):
    """What 1000 and 1018:01, 1018:02 must say."""

    device_type: U32
    vendor: U32
    product: U32


class Heartbeat(Spec):
    """ms: how often drive and controller say that they live, and after which silence the drive stops."""

    drive: Milliseconds = 100
    controller: Milliseconds = 50
    consumer: Milliseconds = 250


class DriveTable(Spec):
    """A type of drive: identity, units, objects, PDOs, modes, what is written at boot, where settings go.

    axes: motors in one node; remappable: whether the mapping of its PDOs may be written; interpolates:
    whether it has 60C2; homes: whether it is homed before it is used, by the method that is written to it;
    writes: as they stand; period: objects that follow from the control period (s);
    settings: objects that follow from words and numbers of the scenario.
    """

    name: str
    identity: Identity
    axes: Annotated[int, Field(ge=1, le=8)] = 1
    units: Units
    objects: dict[str, Object]
    pdos: dict[PdoName, Pdo]
    remappable: bool = True
    interpolates: bool = False
    homes: bool = False
    modes: dict[str, int]
    heartbeat: Heartbeat = Heartbeat()
    writes: list[Write] = Field(default_factory=list)
    period: list[Setting] = Field(default_factory=list)
    settings: dict[str, Setting] = Field(default_factory=dict)

    @property
    def positions(self) -> bool:
        """Whether an RPDO maps a target position: the drive holds an angle, not a speed."""
        return any("target_position" in self.pdos[name].map for name in self.receives)

    @property
    def target(self) -> str:
        """The word of the object that is commanded besides the controlword."""
        return TARGETS[self.positions]

    @model_validator(mode="after")
    def _complete(self) -> DriveTable:
        problems = list(self._lacking()) or list(self._unmapped())
        if problems:
            raise ValueError("; ".join(problems))
        return self

    def _lacking(self) -> Iterator[str]:
        commanded = ("controlword", self.target)
        for word in (*commanded, "statusword", "mode"):
            if word not in self.objects:
                yield f"objects has no {word}"
        if self.homes and "homing" not in self.modes:
            yield "it homes, but modes has no homing"
        if isinstance(self.units.polarity, list) and len(self.units.polarity) != self.axes:
            yield f"units.polarity has {len(self.units.polarity)} signs for {self.axes} axes"
        for name, pdo in self.pdos.items():
            for item in pdo.map:
                if self._find(item) is None:
                    yield f"{name} maps {item!r}, which is not among the objects"

    def _unmapped(self) -> Iterator[str]:
        for name in self.pdos:
            if sum(bit_length(entry.type) for entry in self.mapped(name)) > 64:
                yield f"{name} is longer than 8 bytes"
        told = {(value.word, value.axis) for name in self.receives for value in self.values(name)}
        sent = {(value.word, value.axis) for name in self.sends for value in self.values(name)}
        commanded = ("controlword", self.target)
        for kind, words, mapped in (("RPDO", commanded, told), ("TPDO", MEASURED, sent)):
            for word, axis in product(words, range(1, self.axes + 1)):
                if not mapped & {(word, 0), (word, axis)}:
                    yield f"no {kind} maps {word}" + (f" of axis {axis}" if self.axes > 1 else "")
        others = sorted({word for word, _ in told} - {*commanded})
        if others:
            yield f"an RPDO maps {others[0]}; the bench commands {' and '.join(commanded)} only"

    @property
    def receives(self) -> list[str]:
        """Names of the RPDOs, in the order in which they are sent to the drive."""
        return [name for name in self.pdos if name[0] == "r"]

    @property
    def sends(self) -> list[str]:
        """Names of the TPDOs."""
        return [name for name in self.pdos if name[0] == "t"]

    def mapped(self, pdo: str) -> list[Entry]:
        """Returns the entries that a PDO maps, in order."""
        return [entry.of(axis or 1) for _, entry, axis in self._items(pdo)]

    def values(self, pdo: str) -> list[MappedValue]:
        """Returns the values in a PDO, in order; an entry with halves holds two of them."""
        return [
            MappedValue(word, owner, data_type)
            for word, entry, axis in self._items(pdo)
            for owner, data_type in entry.parts(axis)
        ]

    def codec(self, pdo: str, axis: int = 1) -> PdoCodec:
        """Returns the compiled mapping of a PDO as one axis sees it: what is another's is passed over."""
        return PdoCodec(
            [(value.word if value.axis in (0, axis) else "", value.type) for value in self.values(pdo)]
        )

    def _items(self, pdo: str) -> list[tuple[str, Object, int]]:
        found = [self._find(item) for item in self.pdos[pdo].map]
        return [item for item in found if item is not None]

    def _find(self, item: str) -> tuple[str, Object, int] | None:
        """Returns word, object and axis (0: none named) of an item of a mapping, None where it is none."""
        word, dot, axis = item.partition(".")
        entry = self.objects.get(word)
        if entry is None or bool(dot) != (entry.per_axis == "sub"):
            return None
        if not dot:
            return word, entry, 0
        return (word, entry, int(axis)) if axis.isdecimal() and 1 <= int(axis) <= self.axes else None


def bundled_tables() -> list[str]:
    """Returns the names of the drive types that come with hilbed."""
    return sorted(path.stem for path in TABLES.glob("*.yaml"))


def is_file(name: str) -> bool:
    """Tells whether a table is named by its file, not by its type."""
    return name.endswith((".yaml", ".yml"))


def load_table(name: str) -> DriveTable:
    """Returns a bundled table by name, or that of a file by its absolute path; ScenarioError."""
    if is_file(name):
        path = Path(name)
        if not (path.is_absolute() and path.is_file()):
            raise ScenarioError(f"there is no drive table {name}; a scenario's own lies in its folder")
        return _kept(path, path.stat().st_mtime_ns)
    if name not in bundled_tables():
        raise ScenarioError(f"no drive table {shorten(name)}{nearest(name, bundled_tables())}")
    return _bundled(name)


def named_table(name: str) -> DriveTable:
    """Returns the table that a user names on the command line: by its type, or by its file."""
    return load_table(str(Path(name).resolve()) if is_file(name) else name)


@cache
def _bundled(name: str) -> DriveTable:
    """Reads a table that comes with hilbed and therefore holds."""
    return DriveTable.model_validate(_content(name))


def _content(name: str) -> dict[str, Any]:
    """Returns what is in a bundled table's file, and for the rest what is in the one that it is like."""
    content: dict[str, Any] = yaml.load((TABLES / f"{name}.yaml").read_bytes(), _LOADER)
    like = content.pop("like", None)
    return content if like is None else {**_content(like), **content}


@lru_cache(maxsize=16)
def _kept(path: Path, _: int) -> DriveTable:
    return read_table(path)


def read_table(path: Path) -> DriveTable:
    """Reads a table's file; ScenarioError with file, line and key of everything that is wrong in it."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ScenarioError(f"{path}: cannot be read: {error}") from None
    data, marks = yaml12.read(text, str(path))
    try:
        return DriveTable.model_validate(data)
    except ValidationError as error:
        places = problems.Places(str(path), marks)
        raise ScenarioError(places.tell(problems.from_validation(error, DriveTable))) from None
