"""Every command in every situation of the axis, against the profile: `disagreements` tells what differs."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

from firmware_sim.axis import Axis
from firmware_sim.cia402 import Command, State
from firmware_sim.dictionary import ObjectDictionary
from firmware_sim.entry import key
from firmware_sim.errors import ErrorCode, Errors
from tests.firmware import profile
from tests.firmware.profile import COAST, FULL, QUICK, SLOW

SUPPLY = 96  # 24 V in quarters
TARGET = 630  # counts/s: six ticks at the rate of 6084
SPEED = TARGET / 66_000 * math.tau
WORDS = {
    Command.SHUTDOWN: 0x06,
    Command.SWITCH_ON: 0x07,
    Command.ENABLE: 0x0F,
    Command.DISABLE_VOLTAGE: 0x00,
    Command.QUICK_STOP: 0x02,
    Command.FAULT_RESET: 0x80,
}
FALLS = {SLOW: 105_000 / 66_000 * math.tau * 1e-3, QUICK: 525_000 / 66_000 * math.tau * 1e-3, FULL: math.inf}


class Options(NamedTuple):
    """Values of 605A, 605B, 605C, 605E."""

    quick_stop: int = 2
    shutdown: int = 0
    disable: int = 0
    reaction: int = 2


class Machine:
    """An axis without a bus, its wheel at rest."""

    def __init__(self, options: Options) -> None:
        self._values = ObjectDictionary(1).values
        self.axis = Axis(self._values, Errors(self._values))
        self._options = options

    def power(self) -> None:
        self.axis.reset()
        for index, value in zip((0x605A, 0x605B, 0x605C, 0x605E), self._options, strict=True):
            self._values[key(index)] = value
        self._values[key(0x6060)] = 9
        self._values[key(0x60FF)] = TARGET
        self.axis.changed(0x6060)

    def send(self, *words: int) -> None:
        for word in words:
            self._values[key(0x6040)] = word
            self.axis.changed(0x6040)

    def run(self, ticks: int) -> None:
        for _ in range(ticks):
            self.axis.tick(0, 0, SUPPLY)

    @property
    def shown(self) -> State:
        """The state in the statusword."""
        self.axis.refresh()
        return profile.state(self._values[key(0x6041)])


class Situation(NamedTuple):
    """A state and how it is reached; left alone the axis comes to rest in `end`, if that is another one."""

    name: str
    state: State
    way: Callable[[Machine], None]
    options: Options = Options()
    end: State | None = None


def _drive(machine: Machine) -> None:
    machine.power()
    machine.send(0x06, 0x07, 0x0F)
    machine.run(2)


def _driving_then(*words: int) -> Callable[[Machine], None]:
    def way(machine: Machine) -> None:
        _drive(machine)
        machine.send(*words)

    return way


def _standing_then(*words: int) -> Callable[[Machine], None]:
    def way(machine: Machine) -> None:
        machine.power()
        machine.send(*words)

    return way


def _reacting(machine: Machine) -> None:
    _drive(machine)
    machine.axis.fail(ErrorCode.UNDERVOLTAGE)


def _failed(machine: Machine) -> None:
    _drive(machine)
    machine.axis.fail(ErrorCode.OVERCURRENT)


def _held(machine: Machine) -> None:
    _drive(machine)
    machine.send(0x02)
    machine.run(20)


S = State
RAMPS = Options(6, 1, 1, 1)
SITUATIONS = (
    Situation("without power", S.NOT_READY, lambda _: None),
    Situation("powered", S.SWITCH_ON_DISABLED, _standing_then()),
    Situation("ready", S.READY, _standing_then(0x06)),
    Situation("switched on", S.SWITCHED_ON, _standing_then(0x06, 0x07)),
    Situation("driving", S.ENABLED, _drive),
    Situation("powered, all by ramps", S.SWITCH_ON_DISABLED, _standing_then(), RAMPS),
    Situation("ready, all by ramps", S.READY, _standing_then(0x06), RAMPS),
    Situation("switched on, all by ramps", S.SWITCHED_ON, _standing_then(0x06, 0x07), RAMPS),
    Situation("driving, all by ramps", S.ENABLED, _drive, RAMPS),
    Situation("driving, shutdown by a ramp", S.ENABLED, _drive, Options(shutdown=1)),
    Situation("driving, disable by a ramp", S.ENABLED, _drive, Options(disable=1)),
    *(Situation(f"driving, 605A = {k}", S.ENABLED, _drive, Options(k)) for k in profile.QUICK_STOP_OPTIONS),
    Situation("on a ramp to ready", S.ENABLED, _driving_then(0x06), Options(shutdown=1), S.READY),
    Situation("on a ramp to switched on", S.ENABLED, _driving_then(7), Options(disable=1), S.SWITCHED_ON),
    Situation("on a quick stop", S.QUICK_STOP, _driving_then(0x02), end=S.SWITCH_ON_DISABLED),
    Situation("on a slow quick stop", S.QUICK_STOP, _driving_then(0x02), Options(1), S.SWITCH_ON_DISABLED),
    Situation("on a quick stop that holds", S.QUICK_STOP, _driving_then(0x02), Options(6)),
    Situation("held by a quick stop", S.QUICK_STOP, _held, RAMPS),
    Situation("reacting to a fault", S.REACTION, _reacting, end=S.FAULT),
    Situation("reacting by a ramp", S.REACTION, _reacting, Options(reaction=1), S.FAULT),
    Situation("failed", S.FAULT, _failed),
    Situation("failed, all by ramps", S.FAULT, _failed, RAMPS),
)


class Outcome(NamedTuple):
    """States at once and at rest, power at once, and how much the reference has fallen after a tick."""

    at_once: State
    at_rest: State
    powered: bool
    fall: float


def disagreements(first: State = State.ENABLED) -> Iterator[str]:
    """Yields every command of every situation in which the axis does not do what the profile says.

    Situations of the state `first` come first.
    """
    for situation in sorted(SITUATIONS, key=lambda situation: situation.state is not first):
        for command in Command:
            try:
                found: object = _seen(situation, command)
            except Exception as error:  # a drive that breaks down disagrees, too
                found = repr(error)
            wanted = _expected(situation, command)
            if found != wanted:
                yield f"{situation.name}: {command.name}: {found}, not {wanted}"


def _seen(situation: Situation, command: Command) -> Outcome | str:
    machine = Machine(situation.options)
    situation.way(machine)
    if machine.shown is not situation.state:
        return f"not reached: {machine.shown.name}"
    before = machine.axis.speed_ref
    machine.send(WORDS[command])
    at_once, powered = machine.shown, machine.axis.bridge_enabled
    machine.run(1)
    fall = before - machine.axis.speed_ref
    machine.run(30)
    return Outcome(at_once, machine.shown, powered, round(fall, 9))


def _expected(situation: Situation, command: Command) -> Outcome:
    state, end, options = situation.state, situation.end, situation.options
    target = profile.TRANSITIONS.get((state, command))
    unstoppable = state is S.QUICK_STOP and end is not None and command is Command.ENABLE
    if state is S.ENABLED and command is Command.ENABLE:  # takes a ramp back, else changes nothing
        return _outcome(situation, None, state, state)
    if target is None or unstoppable:
        return _outcome(situation, _going(situation), state, end or state)
    if target is S.QUICK_STOP:
        ramp, end = profile.QUICK_STOP_OPTIONS[options.quick_stop]
        return _outcome(situation, ramp, end if ramp is COAST else target, end)
    chosen = {Command.SHUTDOWN: options.shutdown, Command.SWITCH_ON: options.disable}
    ramp = profile.RAMP_OPTIONS[chosen.get(command, 0)] if state is S.ENABLED else COAST
    if ramp is not COAST:
        return _outcome(situation, ramp, state, target)
    return _outcome(situation, None if target is S.ENABLED else COAST, target, target)


def _going(situation: Situation) -> str | None:
    """Returns the ramp that is under way where no command changes anything."""
    options = situation.options
    if situation.state is S.QUICK_STOP:
        return profile.QUICK_STOP_OPTIONS[options.quick_stop][0]
    if situation.state is S.REACTION:
        return profile.RAMP_OPTIONS[options.reaction]
    return SLOW if situation.end is not None else None


def _outcome(situation: Situation, ramp: str | None, at_once: State, at_rest: State) -> Outcome:
    moving = situation.state in profile.POWERED and situation.way is not _held
    start = SPEED if moving else 0.0
    if ramp is None:
        fall = start - SPEED if at_once is S.ENABLED else 0.0  # in CSV there is no ramp to the target
    else:
        fall = start if ramp is COAST else min(start, FALLS[ramp])
    return Outcome(at_once, at_rest, at_once in profile.POWERED, round(fall, 9))
