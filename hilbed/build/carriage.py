"""What carries the frames of a bench: the wire, its pace, and the bus that it is joined to."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from typing import Any, NamedTuple

from hilbed.can.channels import lend
from hilbed.can.gateway import Gateway, Medium
from hilbed.can.node import Node
from hilbed.can.specs import BusSpec
from hilbed.can.wire import Wire
from hilbed.pacer import Paced, Pacer
from hilbed.types import Nanos

PATIENCE = 5.0
"""s of the wall clock for which a run in lockstep waits for a slow driver."""


class Carriage(NamedTuple):
    """The wire and who moves it; gateway: to a python-can bus, pacer: to the wall clock, if there are any."""

    wire: Wire
    medium: Medium
    gateway: Gateway | None
    pacer: Pacer | None

    def start(self, t: Nanos) -> None:
        """It is `t` now."""
        if self.pacer is not None:
            self.pacer.start(t)

    def due(self, t: Nanos) -> bool:
        """Waits for a cycle's beginning in real time; returns whether its commands may still be sent.

        Where everybody is in this process, the drives wait as well: no command is too late for them.
        """
        kept = self.pacer is None or self.pacer.due(t)
        if self.gateway is None:
            return True
        self.gateway.pull(t)
        return kept

    def stop(self) -> None:
        """From now on what goes wrong on the bus is no news."""
        self.wire.relax()
        if self.gateway is not None:
            self.gateway.stop()

    def account(self) -> dict[str, Any]:
        """Returns what verdict.json says of the other bus: its name and what was counted."""
        return {} if self.gateway is None else {"adapter": self.gateway.account()}


def join(
    wire: Wire, bus: BusSpec, nodes: Sequence[Node], pacer: Pacer | None, closing: ExitStack
) -> Carriage:
    """Joins the wire to what the scenario names; `closing` undoes it. ScenarioError where it cannot be."""
    medium: Medium = wire if pacer is None else Paced(wire, pacer)
    if bus.guests is not None:
        closing.enter_context(lend(bus.guests, wire))
    if not bus.carried:
        return Carriage(wire, medium, None, pacer)
    from hilbed.can.hardware import Adapter

    patience = PATIENCE if pacer is None else 0.0
    adapter = Adapter(bus.interface, bus.channel, bus.bitrate, patience)
    closing.callback(adapter.close)
    gateway = Gateway(wire, adapter, medium, lockstep=pacer is None)
    for node in nodes:
        (gateway.here if node.kind == "simulated" else gateway.elsewhere)(node)
    return Carriage(wire, gateway, gateway, pacer)
