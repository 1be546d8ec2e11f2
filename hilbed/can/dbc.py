"""The active PDO mapping as a DBC file, for cantools, SavvyCAN, Wireshark and whoever else reads a log.

Speeds, angles and currents come out in SI units at the wheel, as in signals.npz; all else as its object
holds it. The fixed services of CANopen have their messages, too, so that every frame of a log decodes.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterator, Mapping, Sequence

from cantools.database.can import Database, Message, Signal
from cantools.database.can import Node as Member
from cantools.database.conversion import BaseConversion
from cantools.database.namedsignalvalue import NamedSignalValue

from hilbed.can import nmt
from hilbed.can.cob import CONTROLLER_ID, EMERGENCY, HEARTBEAT, NMT, SDO_ANSWER, SDO_REQUEST, SYNC
from hilbed.can.codec import bit_length
from hilbed.can.node import Node, by_number
from hilbed.can.objects import MappedValue

CONTROLLER = "controller"

RECORDED = {"velocity_actual": "speed_measured", "current_actual": "current_measured"}
"""Under which name in signals.npz a value is recorded."""


def dbc(nodes: Sequence[Node]) -> str:
    """Returns the text of the DBC file for drives on one bus."""
    return str(database(nodes).as_dbc_string())


def database(nodes: Sequence[Node]) -> Database:
    """Returns the messages of drives on one bus: their PDOs and every service of the bench."""
    members = [Member(node.name, f"{node.table.name}, node {node.id}") for node in nodes]
    return Database(list(_messages(nodes)), [Member(CONTROLLER, "the bench"), *members])


def _messages(nodes: Sequence[Node]) -> Iterator[Message]:
    yield _message(NMT, "nmt", [_signal("command", 0, "u8", _NMT), _signal("node", 8, "u8")], CONTROLLER)
    yield _message(SYNC, "sync", [], CONTROLLER)
    yield _heartbeat(CONTROLLER_ID, CONTROLLER)
    for number, axes in by_number(nodes).items():
        name = "_".join(axis.name for axis in axes)
        for pdo in axes[0].table.pdos:
            yield _pdo(axes, pdo, f"{name}_{pdo}")
        yield _message(
            EMERGENCY + number,
            f"{name}_emergency",
            [_signal("code", 0, "u16"), _signal("register", 16, "u8"), _signal("maker", 24, "u40")],
            axes[0].name,
        )
        yield _heartbeat(number, name, axes[0].name)
        yield _message(SDO_REQUEST + number, f"{name}_sdo_request", _SDO, CONTROLLER)
        yield _message(SDO_ANSWER + number, f"{name}_sdo_answer", _SDO, axes[0].name)


def _pdo(axes: Sequence[Node], pdo: str, name: str) -> Message:
    table, start, signals = axes[0].table, 0, []
    for value in table.values(pdo):
        signals.append(_mapped(axes, value, start))
        start += bit_length(value.type)
    sends = pdo[0] == "t"
    sender = axes[0].name if sends else CONTROLLER
    timer = table.pdos[pdo].event_timer if sends else 0
    return _message(table.pdos[pdo].cob_id + axes[0].id, name, signals, sender, timer or None)


def _mapped(axes: Sequence[Node], value: MappedValue, start: int) -> Signal:
    """Returns the signal of a mapped value, named after its drive where the node has several."""
    owner = next((axis for axis in axes if value.axis in (0, axis.axis)), None)
    alone = axes[0].table.axes == 1 or value.axis == 0
    name = value.word if alone else f"{owner.name if owner else f'axis{value.axis}'}_{value.word}"
    if owner is None:
        return _signal(name, start, value.type)
    entry = owner.table.objects[value.word].of(owner.axis)
    comment = f"object {entry.index:04X}:{entry.sub:02X}"
    if value.word in RECORDED:
        comment += f"; drive/{owner.name}/{RECORDED[value.word]} of signals.npz"
    choices = {number: mode for mode, number in owner.table.modes.items()} if "mode" in value.word else {}
    return _signal(name, start, value.type, choices, *scaling(owner, value.word), comment)


def scaling(node: Node, word: str) -> tuple[float, str]:
    """Returns SI units a number in an object, and the unit; 1 and none for an object without."""
    scales = {
        "target_velocity": (1 / node.velocity_per_radian, "rad/s"),
        "target_position": (1 / node.counts_per_radian, "rad"),
        "velocity_actual": (1 / node.actual_per_radian, "rad/s"),
        "position_actual": (1 / node.counts_per_radian, "rad"),
        "current_actual": (node.amperes, "A"),
        "supply": (1e-3, "V"),
    }
    return scales.get(word, (1, ""))


def _message(
    identifier: int, name: str, signals: Sequence[Signal], sender: str, cycle_time: int | None = None
) -> Message:
    bits = max((signal.start + signal.length for signal in signals), default=0)
    return Message(identifier, name, (bits + 7) // 8, list(signals), senders=[sender], cycle_time=cycle_time)


def _heartbeat(number: int, name: str, sender: str | None = None) -> Message:
    state = _signal("state", 0, "u8", nmt.STATE_NAMES)
    return _message(HEARTBEAT + number, f"{name}_heartbeat", [state], sender or name)


def _signal(
    name: str,
    start: int,
    data_type: str,
    choices: Mapping[int, str | NamedSignalValue] | None = None,
    scale: float = 1,
    unit: str = "",
    comment: str | None = None,
) -> Signal:
    words = OrderedDict(choices) if choices else None
    conversion = BaseConversion.factory(scale=scale, choices=words, is_float=data_type[0] == "f")
    return Signal(
        name,
        start,
        int(data_type[1:]),
        is_signed=data_type[0] == "i",
        conversion=conversion,
        unit=unit or None,
        comment=comment,
    )


_NMT = {
    nmt.START: "start",
    nmt.STOP: "stop",
    nmt.ENTER_PREOPERATIONAL: "enter pre-operational",
    nmt.RESET_NODE: "reset node",
    nmt.RESET_COMMUNICATION: "reset communication",
}
_SDO = [
    _signal("command", 0, "u8"),
    _signal("index", 8, "u16"),
    _signal("subindex", 24, "u8"),
    _signal("data", 32, "u32"),
]
