"""The motion side of the drive: state machine, speed reference, loop and protection. Knows no bus."""

from __future__ import annotations

from typing import Any, Final

from firmware_sim import cia402, status
from firmware_sim.cia402 import OPTIONS, QUICK_STOPS, TRANSITIONS, Command, Ramp, State, Stop
from firmware_sim.entry import key
from firmware_sim.errors import ErrorCode, Errors
from firmware_sim.modes import MODES, Plan, stopping
from firmware_sim.objects.profile import POSITION_MODES
from firmware_sim.positioner import Positioner
from firmware_sim.ramp import approach
from firmware_sim.settings import read_loop, read_motor, read_settings
from firmware_sim.speedmeter import Speedmeter

_CONTROL, _MODE, _DISPLAY, _TARGET = key(0x6040), key(0x6060), key(0x6061), key(0x60FF)
_INPUTS = key(0x60FD)
# Bound here: to look up a member of an enumeration takes longer than a multiplication.
_ENABLED: Final = State.ENABLED
_POWERED = (State.ENABLED, State.QUICK_STOP, State.REACTION)
_STOP_TICKS: Final = 1000  # a wheel that something keeps turning is let go after a second at zero reference
_LOW_TICKS: Final = 5  # a supply may sag for so long
_QUARTER: Final = 0.25  # V
FULL_DUTY: Final = 32767


class Axis:
    """One motor. `speed_ref` (rad/s, in the encoder's direction) is what the loop follows now.

    event: state, mode or error code have changed since the owner looked (and put it back);
    limited: the target is beyond the highest speed.
    """

    def __init__(self, values: dict[int, Any], errors: Errors) -> None:
        self.values = values
        self.errors = errors
        self.state = State.NOT_READY
        self.bridge_enabled = False
        self.speed_ref = 0.0
        self.event = False
        self.clipped = self.halted = self.limited = False
        self.counts = self.current = self.supply = 0
        self.stop: Stop | None = None
        self._word = self._low = self._stopped = self._inputs = 0
        self.meter = Speedmeter(1, 0.0)
        self.positioner = Positioner(values, read_settings(values))
        self._tune()

    def reset(self) -> None:
        """Power-on: chopper open, no errors, waiting for the master."""
        self._word = 0
        self.halted = False
        self.positioner = Positioner(self.values, self.settings)
        self.values[_INPUTS] = self._inputs
        self.errors.clear(*ErrorCode)
        self._tune()
        self._enter(State.SWITCH_ON_DISABLED)

    def tick(self, counts: int, current: int, supply: int) -> int:
        """Runs one control period of 1 ms: counts (I32), mA, quarters of a volt; returns the duty in Q15."""
        speed = self.meter.step(counts)
        self.counts = counts
        self.current = current
        self.supply = supply
        if not self.bridge_enabled:
            return 0
        if supply < self._least or not -self._trip <= current <= self._trip:
            self._protect()
            if not self.bridge_enabled:
                return 0
        else:
            self._low = 0
        ref = self.speed_ref
        target, rise, fall = self.plan
        if self.positioner.active:
            target = self.positioner.step(counts)
            if self.positioner.place.event and self._fails():
                if not self.bridge_enabled:
                    return 0
                target, rise, fall = self.plan
        if ref != target:
            ref = self.speed_ref = approach(ref, target, rise, fall)
        low, high = self._window(speed, supply * _QUARTER)
        duty = self._step(ref, speed, low, high)
        self.clipped = not low < duty < high
        if self.stop is not None and ref == 0.0:
            self._rest(self.stop, speed)
            if not self.bridge_enabled:
                return 0
        return round(duty * FULL_DUTY)

    def read(self, inputs: int) -> None:
        """Takes the digital inputs, in the bits of 60FD."""
        self._inputs = self.values[_INPUTS] = inputs
        self.event = True

    def refresh(self) -> None:
        """Writes statusword and actual values into the dictionary."""
        status.refresh(self)

    def changed(self, index: int) -> None:
        """A value of this object was written over the bus."""
        if index == 0x6040:
            self._command()
        elif index < 0x6000:
            self._tune()
        else:
            if index != 0x60FF:
                self._configure()
            self._replan()

    def disconnected(self, code: ErrorCode) -> None:
        """The master has gone: does what 6007 says."""
        option = self.values[key(0x6007)]
        if option == 1:
            self.fail(code)
        elif option == 2:
            self._obey(Command.DISABLE_VOLTAGE)
        elif option == 3:
            self._obey(Command.QUICK_STOP)

    def fail(self, code: ErrorCode) -> None:
        """Goes to FAULT: by the reaction of 605E, or with the chopper opened at once."""
        self.errors.set(code)
        ramp = Ramp(self.values[key(0x605E)])
        if not self.bridge_enabled or code is ErrorCode.OVERCURRENT:
            ramp = Ramp.COAST
        if self.state is not State.FAULT and (self.state is not State.REACTION or ramp is Ramp.COAST):
            self._leave(Stop(ramp, State.FAULT), State.REACTION)

    @property
    def faulted(self) -> bool:
        return self.state in (State.REACTION, State.FAULT)

    def _command(self) -> None:
        word = self.values[_CONTROL]
        if word != self._word or self.state is not _ENABLED or self.stop is not None:
            command = cia402.decode(self._word, word)
            before, self._word = self._word, word
            self.halted = bool(word & cia402.HALT)
            if command is not None:
                self._obey(command)
            if self.state is _ENABLED:
                self.positioner.heed(self.values[_MODE], before, word, self.counts)
                self._fails()
        self._replan()

    def _fails(self) -> bool:
        """Takes over what has become of a position mode; tells whether the axis has to stop for it."""
        place = self.positioner.place
        self.event |= place.event
        place.event = False
        trouble, place.trouble = place.trouble, None
        if trouble is not None:
            self.fail(trouble)
        return trouble is not None

    def _obey(self, command: Command) -> None:
        state = self.state
        if state is _ENABLED and command is Command.ENABLE:
            self.stop = None  # on second thoughts
        target = TRANSITIONS.get((state, command))
        if target is None:
            return
        if target is State.QUICK_STOP:
            self._leave(QUICK_STOPS[self.values[key(0x605A)]], State.QUICK_STOP)
        elif (state, command) in OPTIONS:
            self._leave(Stop(Ramp(self.values[key(OPTIONS[state, command])]), target), state)
        elif command is Command.ENABLE and self.stop is not None and self.stop.end is not state:
            return  # a quick stop that ends in SWITCH ON DISABLED cannot be taken back
        else:
            self._enter(target)

    def _enter(self, state: State) -> None:
        if state is State.SWITCH_ON_DISABLED and self.state is State.FAULT:
            self.errors.clear(*ErrorCode)
        self.state = state
        self.stop = None
        powered = state in _POWERED
        if powered and not self.bridge_enabled:
            self._low = 0
            self._start(self.meter.speed)
        self.bridge_enabled = powered
        if not powered:
            self.speed_ref = 0.0
            self.clipped = False
        self.event = True
        self._replan()

    def _leave(self, stop: Stop, through: State) -> None:
        """Comes to rest as `stop` says; the statusword shows `through` until then."""
        if stop.ramp is Ramp.COAST:
            self._enter(stop.end)
        elif stop != self.stop:
            self._enter(through)
            self.stop = stop
            self._stopped = 0
            self._replan()

    def _rest(self, stop: Stop, speed: float) -> None:
        self._stopped += 1
        if abs(speed) <= self.settings.threshold or self._stopped >= _STOP_TICKS:
            self._enter(stop.end)

    def _protect(self) -> None:
        if self.supply >= self._least:
            self.fail(ErrorCode.OVERCURRENT)
            return
        self._low += 1
        if self._low >= _LOW_TICKS:
            self.fail(ErrorCode.UNDERVOLTAGE)

    def _start(self, ref: float) -> None:
        """Has the loop follow `ref` from the speed that the wheel has, at first without current."""
        speed = self.meter.speed
        self.speed_ref = ref
        self._loop.reset(ref, speed, self._motor.coasting(speed, self.supply * _QUARTER))

    def _tune(self) -> None:
        """Takes new 2xxx values over, without a bump if the wheel is driven."""
        meter = Speedmeter(self.values[key(0x2001)], self.values[key(0x2010, 12)])
        meter.take_over(self.meter)
        self.meter = meter
        self._motor = read_motor(self.values)
        self._window = self._motor.window
        self._loop = read_loop(self.values)
        self._step = self._loop.step
        self._configure()
        if self.bridge_enabled:
            self._start(self.speed_ref)
        self._replan()

    def _configure(self) -> None:
        self.settings = read_settings(self.values)
        self._trip = self.settings.trip
        self._least = self.settings.least
        self.positioner.place.configure(self.settings)

    def _replan(self) -> None:
        values, settings = self.values, self.settings
        mode = values[_MODE]
        if mode != values[_DISPLAY]:
            values[_DISPLAY] = mode
            self.event = True
        most, ref = settings.max_speed, self.speed_ref
        if not -most <= ref <= most:
            self.speed_ref = most if ref > 0.0 else -most
        target = values[_TARGET] * settings.unit
        self.limited = not -most <= target <= most
        if self.limited:
            target = most if target > 0.0 else -most
        self.plan = self._planned(target)
        going = self.state is _ENABLED and self.stop is None and not self.halted
        if mode in POSITION_MODES and going:
            self.limited = self.positioner.aim(mode, self.counts)
        elif not self.positioner.idle:
            self.positioner.rest(self.halted and self.state is _ENABLED and self.stop is None)

    def _planned(self, target: float) -> Plan:
        if self.stop is not None:
            return stopping(self.settings, self.stop.ramp)
        if self.state is not _ENABLED:
            return stopping(self.settings, Ramp.QUICK)
        if self.halted:
            return stopping(self.settings, Ramp(self.values[key(0x605D)]))
        return MODES[self.values[_MODE]](self.settings, target)
