"""Brings drives up over the bus as one brings up real ones: reset, identify, configure, start, enable."""

from __future__ import annotations

from collections.abc import Sequence

from hilbed.can import cia402, configuration, emergency, nmt, strangers
from hilbed.can.cob import CONTROLLER_ID
from hilbed.can.link import Link, Pump
from hilbed.can.node import Node, by_number
from hilbed.can.sdo import SdoClient
from hilbed.can.twins import Twins
from hilbed.clock import MILLISECOND
from hilbed.ports import Bus
from hilbed.types import BusError, Nanos

BOOT_UP_TIMEOUT: Nanos = 300 * MILLISECOND
STATE_TIMEOUT: Nanos = 300 * MILLISECOND
SDO_TIMEOUT: Nanos = 100 * MILLISECOND
SLOWER = 5
"""By so much longer is waited for a drive that is not in this process: adapters and machines may be busy."""
HOMING_TIMEOUT: Nanos = 60_000 * MILLISECOND
"""For a drive that looks for a switch; its own time-out is the shorter one."""
SETTLING: Nanos = 20 * MILLISECOND
"""A drive that finds something wrong with its supply or motor says so within this time of being enabled."""


class Master:
    """Boots drives that hang on one bus; the control period (ns) is that of SYNC."""

    def __init__(self, nodes: Sequence[Node], bus: Bus, period: Nanos) -> None:
        self._nodes = tuple(nodes)
        self._bus = bus
        self._period = period

    def boot(self, pump: Pump, start: Nanos, ready: Nanos = 0) -> Nanos:
        """Boots all drives from `start` on and keeps them company until `ready`; returns the time then.

        BusError, with drive, object and what came back, where a drive is missing, is another one, refuses
        an object or does not become enabled, or where all this takes until `ready`.
        """
        self._bus.recv(start)  # a boot-up from before the reset must not be taken for the one after it
        link = Link(self._bus, pump, start, ready)
        heard = nmt.HeartbeatConsumer()
        twins = Twins(heard)
        link.listeners += [heard.hear, twins.hear]
        shortest = min((node.table.heartbeat.controller for node in self._nodes), default=100)
        link.each_step.append(nmt.HeartbeatProducer(self._bus, CONTROLLER_ID, shortest * MILLISECOND).tick)
        groups = [*by_number(self._nodes).values()]
        for axes in groups:
            if axes[0].kind != "real":  # else it has been woken, which takes its own time
                link.send(nmt.command(nmt.RESET_NODE, axes[0].id))
        for axes in groups:
            _await_boot_up(link, heard, axes[0])
        for axes in groups:
            self._bring_up(link, heard, twins, axes)
        link.pause(SETTLING)
        strangers.refuse(link, heard, self._nodes)
        for node in self._nodes:
            _check_enabled(_sdo(link, node), node)
        link.pause(ready - link.t)
        return link.t

    def _bring_up(self, link: Link, heard: nmt.HeartbeatConsumer, twins: Twins, axes: Sequence[Node]) -> None:
        """Identifies, configures, starts and enables a node, all its axes at once."""
        node = axes[0]
        sdo = _sdo(link, node)
        _identify(sdo, node)  # by then the boot-up of power-on and that of the reset have come
        twins.watch(node)
        before = sdo.asked
        for entry, value in configuration.steps(axes, self._period):
            sdo.write(entry.index, entry.sub, entry.type, value)
        for axis in axes:
            _await_mode(link, sdo, axis, axis.first_mode)
        link.send(nmt.command(nmt.START, node.id))
        if not link.until(lambda: heard.states.get(node.id) == nmt.OPERATIONAL, _for(node, STATE_TIMEOUT)):
            state = nmt.STATE_NAMES.get(heard.states.get(node.id, -1), "silent")
            raise BusError(f"{node}: told to start, but its heartbeat (1017) says {state}")
        for axis in axes:
            _enable(link, sdo, axis)
            if axis.table.homes:
                _home(link, sdo, axis)
        twins.check(node, sdo.asked - before)


def _for(node: Node, timeout: Nanos) -> Nanos:
    return timeout if node.kind == "simulated" else SLOWER * timeout


def _sdo(link: Link, node: Node) -> SdoClient:
    return SdoClient(link, node.name, node.id, _for(node, SDO_TIMEOUT))


def _await_boot_up(link: Link, heard: nmt.HeartbeatConsumer, node: Node) -> None:
    timeout = _for(node, BOOT_UP_TIMEOUT)
    if not link.until(lambda: node.id in heard.boots, timeout):
        raise BusError(
            f"{node}: no boot-up message {0x700 + node.id:X} within {timeout // MILLISECOND} ms of "
            "the NMT reset: is it powered and wired, with this node number and bit rate?"
        )


def _identify(sdo: SdoClient, node: Node) -> None:
    """Checks that the drive is of the type whose table is going to be written to it."""
    identity = node.table.identity
    for index, sub, expected in (
        (0x1000, 0, identity.device_type),
        (0x1018, 1, identity.vendor),
        (0x1018, 2, identity.product),
    ):
        found = sdo.read(index, sub, "u32")
        if found != expected:
            raise BusError(
                f"{node} is no {node.table.name}: {index:04X}:{sub:02X} is {found:#x}, expected {expected:#x}"
            )


def _await_mode(link: Link, sdo: SdoClient, node: Node, mode: str) -> None:
    """Waits until the drive shows the mode that it has been given."""
    wanted = node.table.modes[mode]
    if "mode_display" not in node.table.objects:
        return
    entry = node.of("mode_display")
    deadline = link.t + _for(node, STATE_TIMEOUT)
    while (shown := sdo.read(entry.index, entry.sub, entry.type)) != wanted:
        if link.t >= deadline:
            raise BusError(f"{node}: mode {wanted} was written, {entry.index:04X} still shows {shown}")
        link.step()


def _enable(link: Link, sdo: SdoClient, node: Node) -> None:
    """Leads the drive to operation enabled, through a fault reset if need be."""
    control = node.of("controlword")
    deadline = link.t + _for(node, STATE_TIMEOUT)
    while (state := cia402.state_of(_statusword(sdo, node))) != cia402.ENABLED and link.t < deadline:
        word = cia402.towards_enabled(state)
        if word == cia402.FAULT_RESET:  # acts on its rising edge
            sdo.write(control.index, control.sub, control.type, cia402.DISABLE_VOLTAGE)
        if word is not None:
            sdo.write(control.index, control.sub, control.type, word)
        link.step()
    _check_enabled(sdo, node)


def _home(link: Link, sdo: SdoClient, node: Node) -> None:
    """Has the drive find its zero by the method that it has been told, then gives it its own mode back."""
    control, mode = node.of("controlword"), node.of("mode")
    sdo.write(control.index, control.sub, control.type, cia402.HOME)
    deadline = link.t + (HOMING_TIMEOUT if node.searches else _for(node, STATE_TIMEOUT))
    while not (statusword := _statusword(sdo, node)) & cia402.HOMED:
        if statusword & cia402.NOT_HOMED:
            raise BusError(f"{node}: has not found its home{_why(sdo, node)}")
        if link.t >= deadline:
            raise BusError(f"{node}: told to home (bit 4 of 6040), but does not say that it has")
        link.step()
    sdo.write(control.index, control.sub, control.type, cia402.ENABLE_OPERATION)
    target = node.of(node.table.target)
    here = node.of("position_actual")
    position = sdo.read(here.index, here.sub, here.type)
    sdo.write(target.index, target.sub, target.type, position)
    sdo.write(mode.index, mode.sub, mode.type, node.table.modes[node.mode])
    _await_mode(link, sdo, node, node.mode)


def _statusword(sdo: SdoClient, node: Node) -> int:
    entry = node.of("statusword")
    return node.part("statusword", sdo.read(entry.index, entry.sub, entry.type))


def _check_enabled(sdo: SdoClient, node: Node) -> None:
    statusword = _statusword(sdo, node)
    state = cia402.state_of(statusword)
    if state != cia402.ENABLED:
        raise BusError(f"{node}: in {state} (statusword {statusword:#06x}){_why(sdo, node)}")


def _why(sdo: SdoClient, node: Node) -> str:
    """Returns what the drive says about its fault, if it can say so."""
    if "error_code" not in node.table.objects:
        return ""
    entry = node.of("error_code")
    code = node.part("error_code", sdo.read(entry.index, entry.sub, entry.type))
    return f", error code {code:#06x}: {emergency.meaning(code)}" if code else ""
