"""Scenario blocks of the bus and of the drives on it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, field_validator, model_validator

from hilbed.can.drive_table import OWN, POSITION, PROFILE, load_table
from hilbed.can.node import Kind, Node
from hilbed.spec import Finite, NonNegative, Positive, Spec
from hilbed.types import ScenarioError

BIT_RATES = (10_000, 20_000, 50_000, 125_000, 250_000, 500_000, 800_000, 1_000_000)
DEFAULT_TABLES = {"steering": {"csp": POSITION, "pp": PROFILE}}
"""Of drives that hold a position, by mode; all others are of the type OWN."""
WIRE = "hilbed"
"""The wire's own name as an interface of python-can."""


class BusSpec(Spec):
    """The simulated wire, what it is joined to, and what happens when a drive goes silent.

    bitrate: bit/s, one of CiA's; interface, channel: of the python-can bus to which the wire is joined, null
    for none. The interface hilbed, also meant by a channel alone, is the wire itself: python-can buses of
    this process join by can.Bus(interface="hilbed", channel=…). silent: hold (go on with what was heard
    last), quick_stop (of all drives) or fail (the run); silent_after: s without a PDO of a drive. Three lost
    heartbeats are silence as well.
    """

    kind: Literal["wire"] = "wire"
    bitrate: int = 500_000
    interface: str | None = None
    channel: str | int | None = None
    silent: Literal["hold", "quick_stop", "fail"] = "fail"
    silent_after: Positive = 0.1

    @field_validator("bitrate")
    @classmethod
    def _standard(cls, value: int) -> int:
        if value not in BIT_RATES:
            raise ValueError(f"no bit rate of CiA; there are {', '.join(map(str, BIT_RATES))}")
        return value

    @property
    def carried(self) -> bool:
        """Whether the wire is joined to a bus outside of this process."""
        return self.interface not in (None, WIRE)

    @property
    def guests(self) -> str | None:
        """The channel on which python-can buses of this process may join the wire."""
        if self.carried or (self.interface is None and self.channel is None):
            return None
        return "bench" if self.channel is None else str(self.channel)


class NodeSpec(Spec):
    """One drive; what is not given stays as the drive has it.

    kind: simulated (here), ecu (its firmware is a process on the bus, motor and shaft are here) or real
    (drive and motor are elsewhere, the simulated wheel follows the reported speed); id: 1 to 126 (by default
    its place among the robot's drives, from 1); axis: which one of a node that has several; table: of the
    drive's type; loop: of the speed, null where the table has no such setting; mode: csv (targets act at
    once), pv (the drive ramps), csp (it follows a position) or pp (it ramps from set-point to set-point);
    homing: method of an axis that is homed, 37 (where it stands) or 17 to 22 (by a switch);
    counts_per_turn: of the encoder, at the wheel; current_limit: A; slew: rad/s² at the wheel, 0 for none;
    gains: by the names of the table's settings, such as kp, ki, slope.
    """

    kind: Kind = "simulated"
    id: Annotated[int, Field(ge=1, le=126)] | None = None
    axis: Annotated[int, Field(ge=1, le=8)] = 1
    table: str = "hilbed402"
    loop: Literal["variable_structure", "pi", "relay"] | None = "variable_structure"
    mode: Literal["csv", "pv", "csp", "pp"] = "csv"
    homing: Literal[17, 18, 19, 20, 21, 22, 37] | None = None
    counts_per_turn: Annotated[int, Field(ge=4, le=2**24)] | None = None
    current_limit: Positive | None = None
    slew: NonNegative | None = None
    gains: dict[str, Finite] = Field(default_factory=dict)

    @model_validator(mode="before")
    @classmethod
    def _suited(cls, data: Any) -> Any:
        """Fills in what the drive's type takes where hilbed's own default is not for it."""
        if not isinstance(data, dict):
            return data
        try:
            table = load_table(str(data.get("table", OWN)))
        except ScenarioError:
            return data  # told by the table's own check
        defaults: dict[str, Any] = {}
        if "loop" not in table.settings:
            defaults["loop"] = None
        if "csv" not in table.modes:
            defaults["mode"] = next(iter(table.modes))
        return {**defaults, **data}

    @field_validator("table")
    @classmethod
    def _bundled(cls, value: str) -> str:
        try:
            load_table(value)
        except ScenarioError as error:
            raise ValueError(str(error)) from None
        return value

    @model_validator(mode="after")
    def _known(self) -> NodeSpec:
        table = load_table(self.table)
        known = [key for key in table.settings if key not in type(self).model_fields]
        for key in self.gains:
            if key not in known:
                raise ValueError(f"gains: {self.table} has no {key!r}; it has {', '.join(known)}")
        for key in self.settings():
            if key not in table.settings:
                raise ValueError(f"{self.table} has no setting {key!r}")
        if self.mode not in table.modes:
            raise ValueError(f"{self.table} has no mode {self.mode!r}; it has {', '.join(table.modes)}")
        if self.axis > table.axes:
            raise ValueError(f"axis {self.axis}: {self.table} has {table.axes}")
        if table.axes > 1 and self.kind == "ecu":
            raise ValueError(f"an ecu node has one axis, {self.table} has {table.axes}")
        return self

    def settings(self) -> dict[str, float | str]:
        """Returns what is to be set, by the keys of the table's settings."""
        given: dict[str, float | str | None] = {
            "loop": self.loop,
            "counts_per_turn": self.counts_per_turn,
            "current_limit": self.current_limit,
            "slew": self.slew,
            "homing": self.homing,
            **self.gains,
        }
        return {key: value for key, value in given.items() if value is not None}


class TerminalSpec(Spec):
    """A python-can channel of its own for the pins of drives whose firmware is elsewhere; real time only."""

    interface: str
    channel: str | int


def _clash(one: Node, other: Node) -> str:
    """Returns why two drives cannot be in one node; empty if they can: as two axes of it."""
    if one.table.axes == 1 or one.table != other.table:
        return f"nodes: {one.name} and {other.name} have the same node number {one.id}"
    if one.axis == other.axis:
        return f"nodes: {one.name} and {other.name} are both axis {one.axis} of node {one.id}"
    if (one.kind, one.mode) != (other.kind, other.mode):
        return f"nodes: {one.name} and {other.name} are one node, {one.id}: of one kind and in one mode"
    return ""


def with_table(name: str, block: Any) -> Any:
    """Returns a drive's block, or the word that is short for it, with the table that its name asks for."""
    given = {"kind": block} if isinstance(block, str) else block
    if not isinstance(given, dict) or name not in DEFAULT_TABLES:
        return block
    tables = DEFAULT_TABLES[name]
    return {"table": tables.get(given.get("mode", "csp"), POSITION), **given}


def _unsuited(node: Node) -> list[str]:
    """Returns why a drive cannot do what its name says, if so."""
    if node.table.positions != (node.name in DEFAULT_TABLES):
        what, needed = ("a position", "a speed") if node.table.positions else ("a speed", "a position")
        return [f"nodes: {node.name} is told {needed}, a drive of the type {node.table.name} {what}"]
    return []


def resolve(specs: Mapping[str, NodeSpec], drives: Iterable[str]) -> tuple[Node, ...]:
    """Returns the nodes of a robot's drives in their order; ScenarioError with everything that is wrong.

    A drive that the scenario does not mention is simulated with all defaults.
    """
    names = tuple(drives)
    problems = [f"nodes: the robot has no drive {name!r}; it has {', '.join(names)}"
                for name in specs if name not in names]  # fmt: skip
    nodes: list[Node] = []
    for place, name in enumerate(names, start=1):
        spec = specs.get(name) or NodeSpec.model_validate(with_table(name, {}))
        number = spec.id or place
        table = load_table(spec.table)
        node = Node(name, number, table, spec.mode, spec.settings(), spec.axis, spec.kind)
        problems += _unsuited(node)
        problems += [_clash(other, node) for other in nodes if other.id == number and _clash(other, node)]
        nodes.append(node)
    if problems:
        raise ScenarioError("\n".join(problems))
    return tuple(nodes)
