"""CiA 402's state machine, written down for the tests from the profile: nothing here comes from the firmware.

Only the names of states and commands are shared.
"""

from __future__ import annotations

from firmware_sim.cia402 import Command, State

# Rows: states; columns: commands; a dot: the command is not for this state.
GRID = """
                    shutdown  switch_on    enable   disable_voltage     quick_stop          fault_reset
not_ready           .         .            .        .                   .                   .
switch_on_disabled  ready     .            .        .                   .                   .
ready               .         switched_on  enabled  switch_on_disabled  switch_on_disabled  .
switched_on         ready     .            enabled  switch_on_disabled  switch_on_disabled  .
enabled             ready     switched_on  .        switch_on_disabled  quick_stop          .
quick_stop          .         .            enabled  switch_on_disabled  .                   .
reaction            .         .            .        .                   .                   .
fault               .         .            .        .                   .                   switch_on_disabled
"""

# Low byte of the statusword, bit 7 first; x: any.
STATUS = {
    State.NOT_READY: "x0xx0000",
    State.SWITCH_ON_DISABLED: "x1xx0000",
    State.READY: "x01x0001",
    State.SWITCHED_ON: "x01x0011",
    State.ENABLED: "x01x0111",
    State.QUICK_STOP: "x00x0111",
    State.REACTION: "x0xx1111",
    State.FAULT: "x0xx1000",
}
# Low byte of the controlword; a fault is reset by bit 7 as it rises, whatever the other bits.
CONTROL = {
    Command.SHUTDOWN: "0xxxx110",
    Command.SWITCH_ON: "0xxx0111",
    Command.ENABLE: "0xxx1111",
    Command.DISABLE_VOLTAGE: "0xxxxx0x",
    Command.QUICK_STOP: "0xxxx01x",
}
POWERED = (State.ENABLED, State.QUICK_STOP, State.REACTION)
COAST, SLOW, QUICK, FULL = "chopper open", "by 6084", "by 6085", "at once"
# 605A: how the drive comes to rest, and the state that it is in then.
QUICK_STOP_OPTIONS = {
    0: (COAST, State.SWITCH_ON_DISABLED),
    1: (SLOW, State.SWITCH_ON_DISABLED),
    2: (QUICK, State.SWITCH_ON_DISABLED),
    3: (FULL, State.SWITCH_ON_DISABLED),
    5: (SLOW, State.QUICK_STOP),
    6: (QUICK, State.QUICK_STOP),
    7: (FULL, State.QUICK_STOP),
}
# 605B, 605C and 605E, of which 605B and 605C know the first two.
RAMP_OPTIONS = {0: COAST, 1: SLOW, 2: QUICK, 3: FULL}


def _read(grid: str) -> dict[tuple[State, Command], State]:
    head, *rows = (line.split() for line in grid.strip().splitlines())
    return {
        (State[row[0].upper()], Command[command.upper()]): State[target.upper()]
        for row in rows
        for command, target in zip(head, row[1:], strict=True)
        if target != "."
    }


TRANSITIONS = _read(GRID)


def fits(pattern: str, byte: int) -> bool:
    """Tells whether a byte has the bits of a pattern."""
    return all(p in ("x", b) for p, b in zip(pattern, f"{byte & 0xFF:08b}", strict=True))


def state(statusword: int) -> State:
    """Returns the one state that a statusword shows."""
    (found,) = [state for state, pattern in STATUS.items() if fits(pattern, statusword)]
    return found


def command(before: int, word: int) -> Command | None:
    """Returns the command in a controlword that follows another one."""
    if word & 0x80:
        return None if before & 0x80 else Command.FAULT_RESET
    found = [command for command, pattern in CONTROL.items() if fits(pattern, word)]
    assert len(found) == 1, hex(word)
    return found[0]
