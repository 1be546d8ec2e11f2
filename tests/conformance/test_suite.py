"""The suite passes the drive that we ship, fails drives that are broken, and leaves both as they were."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from types import MappingProxyType

import pytest

import firmware_sim.axis
from firmware_sim.cia402 import TRANSITIONS, Command, State
from firmware_sim.dictionary import ENTRIES
from firmware_sim.entry import key
from hilbed.can import cia402
from hilbed.can.drive_table import load_table
from hilbed.can.node import Node
from hilbed.conformance.ends import on_the_wire
from hilbed.conformance.expected import ALLOWED, COMMANDS, after
from hilbed.conformance.subject import Subject
from hilbed.conformance.suite import Terms, perform
from hilbed.drive.desk import Desk
from hilbed.types import BusError, Frame
from tests.conformance.rig import BITRATE, NODE, drive, examined, failed, objects

STATES = (
    cia402.DISABLED,
    cia402.READY,
    cia402.SWITCHED_ON,
    cia402.ENABLED,
    cia402.QUICK_STOP_ACTIVE,
    cia402.FAULT,
)


def test_our_drive_passes_every_check() -> None:
    results = examined(drive())
    assert failed(results) == set()
    assert {result.status for result in results.values()} == {"pass"}
    for state in STATES:
        for command in COMMANDS:
            assert f"states/{state}: {command}" in results
    assert 80 <= (results["load/reached"].measured or 0) <= 100


def test_it_is_deterministic() -> None:
    assert examined(drive()) == examined(drive())


def test_without_arm_no_current_ever_flows() -> None:
    desk = drive()
    powered: list[bool] = []
    tick = desk.tick

    def watched(t, frames):  # type: ignore[no-untyped-def]
        sent = tick(t, frames)
        powered.append(desk.firmware.bridge_enabled)
        return sent

    desk.tick = watched  # type: ignore[method-assign]
    results = examined(desk, armed=False)
    assert powered
    assert not any(powered)
    assert desk.shaft.angle == 0.0
    assert failed(results) == set()
    assert {check for check, result in results.items() if result.status == "not run"} == {
        "states with power",
        "fault",
        "quick stop",
        "abandoned",
        "limits/speed",
        "limits/acceleration",
    }


SAME = [
    where for where, entry in ENTRIES.items() if entry.writable and where not in (key(0x6040), key(0x60FF))
]


def test_the_drive_is_left_stopped_and_as_it_was() -> None:
    desk = drive()
    values = objects(desk)
    values[key(0x6060)] = 9
    values[key(0x6085)] = 400_000
    values[key(0x1A00, 0)] = 2
    before = {where: values[where] for where in SAME}
    examined(desk)
    values = objects(desk)
    after_it = {where: values[where] for where in SAME}
    assert after_it.pop(key(0x1003, 0)) > 0  # errors that were provoked are in the history
    before.pop(key(0x1003, 0))
    after_it.pop(key(0x1A00, 3))  # an entry beyond the mapping's length, which means nothing
    before.pop(key(0x1A00, 3))
    assert after_it == before
    assert values[key(0x60FF)] == 0
    assert not desk.firmware.bridge_enabled
    assert desk.shaft.speed == pytest.approx(0.0, abs=1e-3)


def test_the_expected_machine_is_the_profile_s() -> None:
    """Counted apart from the firmware: 16 commanded transitions 2 to 12, 15, 16; 7 and 10 twice."""
    assert sum(len({*after} - {state}) for (state, _), after in ALLOWED.items()) == 17
    assert after(cia402.FAULT, "shutdown") == (cia402.FAULT,)
    assert after(cia402.DISABLED, "enable operation") == (cia402.DISABLED,)


WORDS = {
    State.SWITCH_ON_DISABLED: cia402.DISABLED,
    State.READY: cia402.READY,
    State.SWITCHED_ON: cia402.SWITCHED_ON,
    State.ENABLED: cia402.ENABLED,
    State.QUICK_STOP: cia402.QUICK_STOP_ACTIVE,
    State.FAULT: cia402.FAULT,
}
COMMAND_WORDS = {
    Command.SHUTDOWN: "shutdown",
    Command.SWITCH_ON: "switch on",
    Command.ENABLE: "enable operation",
    Command.DISABLE_VOLTAGE: "disable voltage",
    Command.QUICK_STOP: "quick stop",
    Command.FAULT_RESET: "fault reset",
}
OPTIONAL = {(State.READY, Command.ENABLE), (State.QUICK_STOP, Command.ENABLE)}


@pytest.mark.sources
@pytest.mark.parametrize("lost", [pair for pair in TRANSITIONS if pair not in OPTIONAL])
def test_a_transition_that_is_missing_is_found(
    lost: tuple[State, Command], monkeypatch: pytest.MonkeyPatch
) -> None:
    left = {pair: state for pair, state in TRANSITIONS.items() if pair != lost}
    monkeypatch.setattr(firmware_sim.axis, "TRANSITIONS", MappingProxyType(left))
    assert failed(examined(drive()))


@pytest.mark.sources
@pytest.mark.parametrize(
    "wrong",
    [
        (State.SWITCH_ON_DISABLED, Command.SWITCH_ON, State.SWITCHED_ON),
        (State.SWITCH_ON_DISABLED, Command.ENABLE, State.READY),
        (State.READY, Command.SHUTDOWN, State.SWITCHED_ON),
        (State.FAULT, Command.SHUTDOWN, State.READY),
        (State.FAULT, Command.DISABLE_VOLTAGE, State.SWITCH_ON_DISABLED),
        (State.QUICK_STOP, Command.SHUTDOWN, State.READY),
    ],
)
def test_a_transition_that_must_not_be_is_found(
    wrong: tuple[State, Command, State], monkeypatch: pytest.MonkeyPatch
) -> None:
    state, command, target = wrong
    more = {**TRANSITIONS, (state, command): target}
    monkeypatch.setattr(firmware_sim.axis, "TRANSITIONS", MappingProxyType(more))
    assert f"states/{WORDS[state]}: {COMMAND_WORDS[command]}" in failed(examined(drive()))


def _deaf(desk: Desk) -> None:
    """Never finds that the controller has gone."""
    desk.firmware._node._lost = lambda *_: None


def _runaway(desk: Desk) -> None:
    """Takes whatever is written to 607F for the highest speed that there is."""
    axis = desk.firmware._axis
    configure = axis._configure

    def unlimited() -> None:
        configure()
        axis.settings = axis.settings._replace(max_speed=1e3)

    axis._configure = unlimited


def _weak(desk: Desk) -> None:
    """Brakes thirty times more slowly than 6085 says."""
    axis = desk.firmware._axis
    configure = axis._configure

    def slow() -> None:
        configure()
        falls = {ramp: fall / 30 for ramp, fall in axis.settings.falls.items()}
        axis.settings = axis.settings._replace(falls=falls)

    axis._configure = slow


def _eager(desk: Desk) -> None:
    """Gains speed three times as fast as 6083 says."""
    axis = desk.firmware._axis
    configure = axis._configure

    def fast() -> None:
        configure()
        axis.settings = axis.settings._replace(rise=3 * axis.settings.rise)

    axis._configure = fast


def _forgetful(desk: Desk) -> None:
    """Sends its PDOs at every other SYNC only."""
    pdos = desk.firmware._node
    on_sync = pdos._on_sync
    count = 0

    def sometimes(t: int, data: bytes) -> None:
        nonlocal count
        count += 1
        if count % 2:
            on_sync(t, data)

    pdos._on_sync = sometimes


@pytest.mark.sources
@pytest.mark.parametrize(
    ("break_it", "checks"),
    [
        (_deaf, {"heartbeat/emergency", "abandoned/standstill", "fault/reached"}),
        (_runaway, {"limits/speed"}),
        (_weak, {"quick stop/time", "quick stop/turn", "abandoned/standstill"}),
        (_eager, {"limits/acceleration"}),
        (_forgetful, {"sync/tpdo1", "sync/tpdo2", "load/tpdo1", "load/tpdo2"}),
    ],
)
def test_a_broken_drive_is_found(break_it: Callable[[Desk], None], checks: set[str]) -> None:
    assert checks <= failed(examined(drive(break_it)))


def test_a_drive_of_another_type_is_told() -> None:
    desk = drive()
    objects(desk)[key(0x1018, 2)] = 0x99
    assert "identity/table" in failed(examined(desk, armed=False))


def test_a_drive_that_somebody_drives_is_left_alone() -> None:
    desk = drive()
    end = on_the_wire(desk, BITRATE)
    subject = Subject(end.link, Node("under test", NODE, load_table("hilbed402")))
    subject.run(1.0)
    with pytest.raises(BusError, match="somebody drives it"):
        list(perform(subject, Terms(True, 1.0, BITRATE, True)))
    assert desk.shaft.speed == pytest.approx(1.0, rel=0.05)


def test_an_empty_bus_is_told() -> None:
    desk = drive()
    end = on_the_wire(desk, BITRATE)
    subject = Subject(end.link, Node("under test", NODE + 1, load_table("hilbed402")))
    with pytest.raises(BusError, match=r"nobody answers as node 6: .* `hilbed bus scan`"):
        list(perform(subject, Terms(True, 1.0, BITRATE, True)))


def test_a_drive_that_falls_silent_is_told() -> None:
    desk = drive()
    end = on_the_wire(desk, BITRATE)
    subject = Subject(end.link, Node("under test", NODE, load_table("hilbed402")))
    results = perform(subject, Terms(True, 1.0, BITRATE, True))
    next(results)
    desk.tick = lambda *_: []  # type: ignore[method-assign]
    with pytest.raises(BusError, match="05040000"):
        list(results)


def test_an_interrupt_while_the_wheel_turns_leaves_it_at_rest_with_its_settings() -> None:
    desk = drive()
    before = {where: objects(desk)[where] for where in SAME}
    tick, interrupts = desk.tick, [KeyboardInterrupt()]

    def interrupted(t: int, frames: Iterable[Frame]) -> list[Frame]:
        if abs(desk.shaft.speed) > 0.8 and interrupts:
            raise interrupts.pop()
        return tick(t, frames)

    desk.tick = interrupted  # type: ignore[method-assign]
    end = on_the_wire(desk, BITRATE)
    subject = Subject(end.link, Node("under test", NODE, load_table("hilbed402")))
    with pytest.raises(KeyboardInterrupt):
        list(perform(subject, Terms(True, 1.0, BITRATE, True)))
    assert desk.shaft.speed == pytest.approx(0.0, abs=1e-3)
    assert not desk.firmware.bridge_enabled
    after_it = {where: objects(desk)[where] for where in SAME}
    ignored = (key(0x1003, 0), key(0x1A00, 2), key(0x1A00, 3))
    assert {w: v for w, v in after_it.items() if w not in ignored} == {
        w: v for w, v in before.items() if w not in ignored
    }
