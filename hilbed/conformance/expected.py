"""The power state machine of CiA 402 as its profile has it: what every command does in every state.

Written down apart from the firmware's own table, which it judges.
"""

from __future__ import annotations

from hilbed.can.cia402 import DISABLED, ENABLED, FAULT, QUICK_STOP_ACTIVE, READY, SWITCHED_ON

COMMANDS = {
    "disable voltage": 0x0000,
    "quick stop": 0x0002,
    "shutdown": 0x0006,
    "switch on": 0x0007,
    "enable operation": 0x000F,
    "fault reset": 0x0080,
}

ALLOWED: dict[tuple[str, str], tuple[str, ...]] = {
    (DISABLED, "shutdown"): (READY,),
    (READY, "switch on"): (SWITCHED_ON,),
    (READY, "enable operation"): (ENABLED, READY),  # at once through switched on, or not at all
    (READY, "disable voltage"): (DISABLED,),
    (READY, "quick stop"): (DISABLED,),
    (SWITCHED_ON, "enable operation"): (ENABLED,),
    (SWITCHED_ON, "shutdown"): (READY,),
    (SWITCHED_ON, "disable voltage"): (DISABLED,),
    (SWITCHED_ON, "quick stop"): (DISABLED,),
    (ENABLED, "switch on"): (SWITCHED_ON,),
    (ENABLED, "shutdown"): (READY,),
    (ENABLED, "disable voltage"): (DISABLED,),
    (ENABLED, "quick stop"): (QUICK_STOP_ACTIVE, DISABLED),  # stays there or not, as 605A says
    (QUICK_STOP_ACTIVE, "disable voltage"): (DISABLED,),
    (QUICK_STOP_ACTIVE, "enable operation"): (ENABLED, QUICK_STOP_ACTIVE),  # transition 16 is optional
    (FAULT, "fault reset"): (DISABLED,),
}
"""Where a command leads; where two states are given, the profile leaves the choice to the maker."""

POWERED = (ENABLED, QUICK_STOP_ACTIVE)
"""States in which the motor has current."""


def after(state: str, command: str) -> tuple[str, ...]:
    """Returns the states that may follow a command: a command that means nothing there changes nothing."""
    if command == "fault reset" and state != FAULT:
        return (state, DISABLED)  # bits 0 to 3 say "disable voltage", which an edge may or may not be
    return ALLOWED.get((state, command), (state,))
