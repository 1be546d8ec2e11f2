"""Faults of the bus and of the nodes on it.

What comes of them by default (`bus.silent: fail`, silent after 0.1 s; drives that stop quickly 5 periods
after the last SYNC and 0.25 s after the last heartbeat of the controller):

| fault | outcome |
|---|---|
| drop, delay of a few frames | the run goes on: a drive keeps its target, the controller its last reading |
| drop of all frames of a drive, delay beyond 0.1 s | the drive is silent: all stop quickly, exit 7 |
| drop of SYNC, or of all frames of the controller | the drives stop by themselves and fall silent: exit 7 |
| corrupt | error frame and another attempt: later, but complete; if certain, bus-off in 5 ms |
| duplicate | nothing: SYNC, targets and positions are absolute |
| babbling_node | lower identifiers first: everything later; at full load no SYNC, so drives stop, exit 7 |
| bus_off of a drive | it hears no SYNC and stops by itself; it is silent: exit 7 |
| bus_off of the controller | it cannot send: exit 7 at once, and the drives stop for want of SYNC |
| lost_heartbeat of the controller | the drives stop quickly, leave operation and are silent: exit 7 |
| lost_heartbeat of a drive | after three of them the controller takes it for silent: exit 7 |
| node_reset | the bridge opens and the wheel coasts; it is silent, the others stop quickly: exit 7 |

With `silent: quick_stop` all drives are stopped and the run goes on; with `hold` the others go on as told. A
drive whose CAN controller recovers, or which boots again, is not enabled again: it rests.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from hilbed.clock import SECOND, nanos
from hilbed.disturbances.schedule import STEADY, Disturbance, DisturbanceBase
from hilbed.effects import Babble, Effects, FrameFault, Surroundings
from hilbed.spec import Fraction, Positive
from hilbed.types import Nanos, Rng

Identifier = Annotated[int, Field(ge=0, le=0x7FF)]


class FrameFaultBase(DisturbanceBase):
    """Which frames: those that a node sends (a drive's name, or controller), those with an identifier.

    probability: with which each of them is hit.
    """

    node: str | None = None
    identifier: Identifier | None = None
    probability: Fraction = 1.0


class Drop(FrameFaultBase):
    """Frames are lost in their node before they get to the bus."""

    kind: Literal["drop"] = "drop"


class Corrupt(FrameFaultBase):
    """A bit comes out inverted on the bus, behind the identifier: an error frame, and another attempt."""

    kind: Literal["corrupt"] = "corrupt"


class Delay(FrameFaultBase):
    """Frames leave their node `delay` s later."""

    kind: Literal["delay"] = "delay"
    delay: Positive


class Duplicate(FrameFaultBase):
    """Frames are sent twice, one after the other."""

    kind: Literal["duplicate"] = "duplicate"


class BabblingNode(DisturbanceBase):
    """A stranger on the bus sends frames of 8 bytes with a low identifier, `rate` of them in a second."""

    kind: Literal["babbling_node"] = "babbling_node"
    identifier: Identifier = 0x001
    rate: Positive


class BusOff(DisturbanceBase):
    """A node's CAN controller is bus-off; after `length` it is allowed to recover (128 × 11 bits)."""

    kind: Literal["bus_off"] = "bus_off"
    node: str


class LostHeartbeat(DisturbanceBase):
    """A node's heartbeats are lost, all else goes on."""

    kind: Literal["lost_heartbeat"] = "lost_heartbeat"
    node: str


class NodeReset(DisturbanceBase):
    """A drive's logic loses its supply for `length` s and then boots; the motor's supply stays."""

    kind: Literal["node_reset"] = "node_reset"
    node: str
    length: Positive | None = 0.05


BusFault = Drop | Corrupt | Delay | Duplicate | BabblingNode | BusOff | LostHeartbeat | NodeReset


def frame_fault(spec: Drop | Corrupt | Delay | Duplicate, _: int, rng: Rng) -> Disturbance:
    """Returns the disturbance that meddles with frames."""
    delay = nanos(spec.delay) if isinstance(spec, Delay) else 0
    fault = FrameFault(spec.kind, spec.node, spec.identifier, spec.probability, rng, delay)
    return lambda _, __, effects: _add(effects, fault)


def lost_heartbeat(spec: LostHeartbeat, _: int, rng: Rng) -> Disturbance:
    """Returns the disturbance that takes a node's heartbeats away."""
    fault = FrameFault("silence", spec.node, None, 1.0, rng)
    return lambda _, __, effects: _add(effects, fault)


def _add(effects: Effects, fault: FrameFault) -> Nanos:
    effects.frames.append(fault)
    return STEADY


def babbling_node(spec: BabblingNode, _: int, __: Rng) -> Disturbance:
    """Returns the disturbance that puts a babbling stranger on the bus."""
    babble = Babble(spec.identifier, max(1, round(SECOND / spec.rate)))

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> Nanos:
        effects.babble.append(babble)
        return STEADY

    return apply


def bus_off(spec: BusOff, _: int, __: Rng) -> Disturbance:
    """Returns the disturbance that takes a node off the bus."""

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> Nanos:
        effects.bus_off.add(spec.node)
        return STEADY

    return apply


def node_reset(spec: NodeReset, _: int, __: Rng) -> Disturbance:
    """Returns the disturbance that takes the supply of a drive's logic away."""

    def apply(_: Nanos, __: Surroundings, effects: Effects) -> Nanos:
        effects.unpowered.add(spec.node)
        return STEADY

    return apply
