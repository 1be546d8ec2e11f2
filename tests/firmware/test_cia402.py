"""The state machine as a master on the bus sees it: against the profile and the canopen library."""

from __future__ import annotations

import itertools
import math

import pytest
from canopen.profiles.p402 import State402

from firmware_sim.cia402 import TRANSITIONS, Command, State
from tests.firmware import profile
from tests.firmware.specification import WORDS
from tests.firmware.wire import Wire, enabled, operational

NAMES = {
    State.NOT_READY: "NOT READY TO SWITCH ON",
    State.SWITCH_ON_DISABLED: "SWITCH ON DISABLED",
    State.READY: "READY TO SWITCH ON",
    State.SWITCHED_ON: "SWITCHED ON",
    State.ENABLED: "OPERATION ENABLED",
    State.QUICK_STOP: "QUICK STOP ACTIVE",
    State.REACTION: "FAULT REACTION ACTIVE",
    State.FAULT: "FAULT",
}


def test_the_library_knows_the_same_states_and_transitions() -> None:
    for state, name in NAMES.items():
        mask, bits = State402.SW_MASK[name]
        assert state & mask == bits
    theirs = {
        (before, word): after
        for (before, after), word in State402.TRANSITIONTABLE.items()
        if before not in ("START", "NOT READY TO SWITCH ON", "FAULT REACTION ACTIVE")
    }
    ours = {(NAMES[s], WORDS[c]): NAMES[t] for (s, c), t in TRANSITIONS.items()}
    assert theirs.items() <= ours.items()
    # What the library leaves out: 3 and 4 at once, 7 and 10 by quick stop.
    assert set(ours) - set(theirs) == {
        ("READY TO SWITCH ON", 0x0F),
        ("READY TO SWITCH ON", 0x02),
        ("SWITCHED ON", 0x02),
    }


def walk(state: State) -> Wire:
    """Returns a drive, its wheel turning, that has been led to a state."""
    wire = (
        enabled()
        if state in (State.ENABLED, State.QUICK_STOP, State.REACTION, State.FAULT)
        else operational()
    )
    for word in {State.READY: (6,), State.SWITCHED_ON: (6, 7)}.get(state, ()):
        wire.command(word)
    if state is State.QUICK_STOP:
        wire.node.sdo[0x605A].raw = 6
        wire.command(0x02)
    elif state is State.REACTION:
        wire.command(0x0F, 50_000)
        wire.run(10, counts_per_tick=50)
        wire.supply = 40
        wire.run(5, counts_per_tick=50)
    elif state is State.FAULT:
        wire.current = 30_000
        wire.run(1)
        wire.current = 0
    assert wire.state() == NAMES[state]
    return wire


REACHABLE = [state for state in State if state is not State.NOT_READY]


@pytest.mark.parametrize(("state", "command"), [*itertools.product(REACHABLE, Command)])
def test_every_command_in_every_state(state: State, command: Command) -> None:
    wire = walk(state)
    wire.node.sdo[0x605C].raw = 0  # disable operation: at once
    expected = profile.TRANSITIONS.get((state, command), state)
    wire.command(WORDS[command])
    assert wire.state() == NAMES[expected]
    assert wire.drive.bridge_enabled == (expected in profile.POWERED)


def test_fault_reset_acts_by_its_edge() -> None:
    wire = walk(State.FAULT)
    wire.command(0x80)
    assert wire.state() == "SWITCH ON DISABLED"
    for word in (0x06, 0x07, 0x0F):
        wire.command(word)
    wire.command(0x8F)
    wire.current = 30_000
    wire.run(1)
    wire.current = 0
    wire.command(0x8F)
    assert wire.state() == "FAULT"  # the bit has been up all the time
    wire.command(0x00)
    wire.command(0x80)
    assert wire.state() == "SWITCH ON DISABLED"


def moving() -> Wire:
    wire = enabled()
    wire.command(0x0F, 50_000)
    wire.run(10)
    return wire


def falling(wire: Wire, ticks: int = 10) -> float:
    """Returns how fast the reference shrinks, rad/s²; infinite where it falls at once."""
    before = wire.drive.speed_ref
    wire.run(ticks)
    after = wire.drive.speed_ref
    return (before - after) / (ticks * 1e-3) if after else math.inf


def check_stopping(wire: Wire, rate: float | None) -> None:
    """Sees the drive come to rest at this rate (rad/s²), or coast where it is None."""
    if rate is None:
        assert not wire.drive.bridge_enabled
    elif rate == math.inf:
        wire.run(1)
        assert wire.drive.speed_ref == 0.0
    else:
        assert falling(wire) == pytest.approx(rate, rel=1e-3)
    wire.run(600)


SLOW, QUICK = 105_000 / 66_000 * math.tau, 525_000 / 66_000 * math.tau


@pytest.mark.parametrize(
    ("option", "rate", "end"),
    [
        (0, None, "SWITCH ON DISABLED"),
        (1, SLOW, "SWITCH ON DISABLED"),
        (2, QUICK, "SWITCH ON DISABLED"),
        (3, math.inf, "SWITCH ON DISABLED"),
        (5, SLOW, "QUICK STOP ACTIVE"),
        (6, QUICK, "QUICK STOP ACTIVE"),
        (7, math.inf, "QUICK STOP ACTIVE"),
    ],
)
def test_quick_stop_options(option: int, rate: float | None, end: str) -> None:
    wire = moving()
    wire.node.sdo[0x605A].raw = option
    wire.command(0x02)
    if rate is not None:
        assert wire.state() == "QUICK STOP ACTIVE"
        wire.command(0x02)  # said again it changes nothing
    check_stopping(wire, rate)
    assert wire.state() == end
    assert wire.drive.speed_ref == 0.0


@pytest.mark.parametrize(
    ("word", "option", "end"), [(0x06, 0x605B, "READY TO SWITCH ON"), (0x07, 0x605C, "SWITCHED ON")]
)
def test_leaving_operation_at_once_or_by_a_ramp(word: int, option: int, end: str) -> None:
    wire = moving()
    wire.node.sdo[option].raw = 0
    wire.command(word)
    assert not wire.drive.bridge_enabled
    wire = moving()
    wire.node.sdo[option].raw = 1
    wire.command(word)
    assert falling(wire) == pytest.approx(SLOW, rel=1e-3)
    assert wire.state() == "OPERATION ENABLED"
    wire.run(600)
    assert wire.state() == end


def test_a_ramp_out_of_operation_can_be_taken_back() -> None:
    wire = moving()
    wire.command(0x07, 50_000)
    wire.run(50)
    assert wire.drive.speed_ref < 4.5
    wire.command(0x0F, 50_000)
    wire.run(600)
    assert wire.state() == "OPERATION ENABLED"
    assert wire.drive.speed_ref > 4.7


def test_a_quick_stop_that_ends_disabled_cannot() -> None:
    wire = moving()
    wire.command(0x02, 50_000)
    wire.command(0x0F, 50_000)
    assert wire.state() == "QUICK STOP ACTIVE"
    wire.run(200)
    assert wire.state() == "SWITCH ON DISABLED"


def test_a_wheel_that_something_keeps_turning_is_let_go() -> None:
    wire = moving()
    wire.command(0x02)
    wire.run(1090, counts_per_tick=20)
    assert wire.state() == "QUICK STOP ACTIVE"
    wire.run(20, counts_per_tick=20)
    assert wire.state() == "SWITCH ON DISABLED"


@pytest.mark.parametrize(("option", "rate"), [(1, SLOW), (2, QUICK)])
def test_halt(option: int, rate: float) -> None:
    wire = moving()
    wire.node.sdo[0x605D].raw = option
    wire.command(0x10F, 50_000)
    assert falling(wire) == pytest.approx(rate, rel=1e-3)
    wire.run(600)
    assert (wire.state(), wire.drive.speed_ref) == ("OPERATION ENABLED", 0.0)
    assert wire.node.sdo[0x6041].raw & 0x0400
    wire.command(0x00F, 50_000)
    wire.run(1)
    assert wire.drive.speed_ref > 4.7


@pytest.mark.parametrize(("option", "rate"), [(0, None), (1, SLOW), (2, QUICK), (3, math.inf)])
def test_fault_reaction_options(option: int, rate: float | None) -> None:
    wire = moving()
    wire.node.sdo[0x605E].raw = option
    wire.supply = 40  # 10 V
    wire.run(4)
    assert wire.state() == "OPERATION ENABLED"  # a short sag is no fault
    wire.run(1)
    assert wire.state() == ("FAULT" if rate in (None, math.inf) else "FAULT REACTION ACTIVE")
    check_stopping(wire, rate)
    assert wire.state() == "FAULT"
    assert [e.code for e in wire.node.emcy.log] == [0x3220]
    assert wire.node.sdo[0x1001].raw == 0x05
    wire.supply = 96
    wire.command(0x80)
    wire.run(1)
    assert [e.code for e in wire.node.emcy.log] == [0x3220, 0]
    assert (wire.node.sdo[0x1001].raw, wire.node.sdo[0x603F].raw) == (0, 0)


@pytest.mark.parametrize("current", [20_100, -20_100])
def test_overcurrent_opens_the_chopper_in_the_same_tick(current: int) -> None:
    wire = moving()
    wire.current = current
    wire.run(1)
    assert not wire.drive.bridge_enabled
    assert wire.duty == 0
    assert wire.state() == "FAULT"
    assert [e.code for e in wire.node.emcy.log] == [0x2310]
    assert wire.node.sdo[0x1001].raw == 0x03


def test_overcurrent_is_no_undervoltage_where_the_supply_just_does() -> None:
    wire = moving()
    wire.supply = 48  # 12 V, the least
    wire.run(10)
    assert wire.state() == "OPERATION ENABLED"
    wire.current = 20_100
    wire.run(1)
    assert [e.code for e in wire.node.emcy.log] == [0x2310]


def test_a_sag_does_not_outlive_the_operation_that_it_was_in() -> None:
    wire = moving()
    wire.supply = 40
    wire.run(4)
    for word in (0x00, 0x06, 0x07, 0x0F):
        wire.command(word)
    wire.run(4)
    assert wire.state() == "OPERATION ENABLED"


def test_short_sags_do_not_add_up() -> None:
    wire = moving()
    for _ in range(10):
        wire.supply = 40
        wire.run(4)
        wire.supply = 96
        wire.run(1)
    assert wire.state() == "OPERATION ENABLED"


def test_the_library_walks_the_state_machine() -> None:
    wire = operational()
    node = wire.node
    for target in (
        "READY TO SWITCH ON",
        "SWITCHED ON",
        "OPERATION ENABLED",
        "SWITCHED ON",
        "SWITCH ON DISABLED",
    ):
        while wire.state() != target:
            step = node._next_state(target) if (wire.state(), target) in State402.TRANSITIONTABLE else None
            step = step or State402.next_state_indirect(wire.state())  # type: ignore[no-untyped-call]
            node.sdo[0x6040].raw = State402.TRANSITIONTABLE[wire.state(), step]
            wire.run(1)
    assert node.is_op_mode_supported("PROFILED VELOCITY")
    assert node.is_op_mode_supported("CYCLIC SYNCHRONOUS VELOCITY")
    assert node.is_op_mode_supported("CYCLIC SYNCHRONOUS POSITION")
    assert not node.is_op_mode_supported("CYCLIC SYNCHRONOUS TORQUE")
