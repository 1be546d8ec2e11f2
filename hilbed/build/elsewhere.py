"""Drives that are not, or not all, in this process: what they need of a run, and how they are reached."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from time import monotonic

from hilbed.build.carriage import Carriage
from hilbed.can.node import Node
from hilbed.can.specs import TerminalSpec
from hilbed.can.terminals import Terminals
from hilbed.can.wake import Wake, Waker
from hilbed.scenario.model import Scenario
from hilbed.types import Nanos, ScenarioError


def check(nodes: Sequence[Node], carriage: Carriage, terminal: TerminalSpec | None) -> None:
    """Raises ScenarioError, with all reasons, where drives elsewhere cannot be part of this run."""
    away = [node.name for node in nodes if node.kind != "simulated"]
    real = [node.name for node in nodes if node.kind == "real"]
    problems = []
    if away and carriage.gateway is None:
        problems.append(
            f"nodes: {_are(away)} elsewhere, but the wire is joined to no bus: say which with -i and -c, "
            "or with bus: {interface, channel}"
        )
    if real and carriage.pacer is None:
        problems.append(
            f"nodes: {_are(real)} real, and a real drive does not wait for simulated time: add --realtime"
        )
    if terminal is not None and carriage.pacer is None:
        problems.append(
            "terminal: two channels keep no order between them, so that a run in lockstep would not be "
            "reproducible: leave it out (pins go over the bus itself), or add --realtime"
        )
    if problems:
        raise ScenarioError("\n".join(problems))


def check_armed(scenario: Scenario, armed: bool) -> None:
    """Raises ScenarioError where real motors would turn and nobody has said that they may."""
    real = [name for name, node in scenario.nodes.items() if node.kind == "real"]
    if real and not armed:
        raise ScenarioError(
            f"nodes: {_are(real)} real: this run moves a real motor, at {scenario.real_speed_limit:g} m/s at "
            "most (real_speed_limit); when its way is free, add --arm"
        )


def terminals_of(
    nodes: Sequence[Node], carriage: Carriage, spec: TerminalSpec | None, closing: ExitStack
) -> Terminals | None:
    """Opens the way to the firmware of all ecu nodes; None where there are none."""
    ecus = [node for node in nodes if node.kind == "ecu"]
    gateway = carriage.gateway
    if not ecus or gateway is None:
        return None
    if spec is not None:
        return _own_channel(ecus, spec, closing)
    terminals = Terminals(ecus, gateway.adapter.send, gateway.pull, monotonic, carriage.pacer is None)
    gateway.intercept(terminals.take)
    return terminals


def wakers(nodes: Sequence[Node], carriage: Carriage, terminals: Terminals | None) -> list[Waker]:
    """Returns what brings up, in the time that it takes there, what is elsewhere."""
    found: list[Waker] = [] if terminals is None else [terminals.power]
    real, gateway = [node for node in nodes if node.kind == "real"], carriage.gateway
    if real and gateway is not None:
        wake = Wake(real, gateway.adapter.send, gateway.pull, monotonic)
        gateway.intercept(wake.take)
        found.append(wake.up)
    return found


def late(answers: Mapping[str, int], terminals: Terminals | None) -> dict[str, int]:
    """Returns how many answers came late: to SYNC by drive, and to the pins of firmware elsewhere."""
    pins = () if terminals is None else terminals.by_node.values()
    return {**answers, **{f"{one.node.name} pins": one.late for one in pins}}


def _own_channel(ecus: Sequence[Node], spec: TerminalSpec, closing: ExitStack) -> Terminals:
    """Pins on a bus of their own, which nothing else is heard from."""
    from hilbed.can.hardware import Adapter

    adapter = Adapter(spec.interface, spec.channel)
    closing.callback(adapter.close)

    def pull(_: Nanos, timeout: float) -> None:
        for frame in adapter.wait(timeout) if timeout else adapter.poll():
            terminals.take(frame)

    terminals = Terminals(ecus, adapter.send, pull, monotonic, lockstep=False)
    return terminals


def _are(names: Sequence[str]) -> str:
    return f"{' and '.join(names)} {'is' if len(names) == 1 else 'are'}"
