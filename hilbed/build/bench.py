"""A rig with what is done before and after its cycles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from hilbed.can.node import Node
from hilbed.clock import MILLISECOND, SECOND
from hilbed.loop import Rig, at_once
from hilbed.ports import Reference
from hilbed.scene import BeaconSpec
from hilbed.types import Array, Nanos, Pose

BOOT: Nanos = SECOND
"""How long before t = 0 simulated drives are powered."""


@dataclass(frozen=True)
class Bench:
    """A rig, ready to boot.

    start: pose at t = 0, as the estimator is told it; kinds: what its sensors measure, with the number of
    components; boot: brings the drives up, ends at t = 0, or where its argument, called at every step,
    raises; stop: brings them to rest from the time given; ticks: the plant's log from a row on; tick: ns;
    events: what the drives did that they should not have; close: gives back what it holds; nodes: the drives
    on the bus; power_on: how long before t = 0 they are powered, time stamps in can.log and log.mcap are t
    plus this; pace: waits for a cycle's beginning, returns whether its commands may still be sent; late:
    answers of each drive that did not come within their cycle; account: what verdict.json says of the bus
    besides.
    """

    rig: Rig
    start: Pose
    reference: Reference | None
    drives: tuple[str, ...]
    kinds: dict[str, int]
    beacons: tuple[BeaconSpec, ...]
    tick: Nanos = MILLISECOND
    boot: Callable[[Callable[[], None]], None] = lambda _: None
    stop: Callable[[Nanos], None] = lambda _: None
    ticks: Callable[[int], dict[str, Array]] = lambda _: {}
    events: Callable[[], list[str]] = list
    close: Callable[[], None] = lambda: None
    nodes: tuple[Node, ...] = ()
    pace: Callable[[Nanos], bool] = at_once
    late: Callable[[], dict[str, int]] = dict
    account: Callable[[], dict[str, Any]] = dict
    power_on: Nanos = BOOT
