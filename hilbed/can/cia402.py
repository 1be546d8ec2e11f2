"""The power state machine of CiA 402 as the controller sees it: statusword in, controlword out."""

from __future__ import annotations

SHUTDOWN, SWITCH_ON, ENABLE_OPERATION = 0x0006, 0x0007, 0x000F
HOME = 0x001F
"""Operation enabled, and in the homing mode: begin."""
HOMED, NOT_HOMED = 0x1000, 0x2000
"""Of the statusword in the homing mode."""
DISABLE_VOLTAGE, QUICK_STOP, FAULT_RESET = 0x0000, 0x0002, 0x0080

NOT_READY = "not ready to switch on"
DISABLED = "switch on disabled"
READY = "ready to switch on"
SWITCHED_ON = "switched on"
ENABLED = "operation enabled"
QUICK_STOP_ACTIVE = "quick stop active"
FAULT_REACTION = "fault reaction active"
FAULT = "fault"

# mask, value, state: the don't-care bits differ (profile's table of statusword bits)
_PATTERNS = (
    (0x4F, 0x00, NOT_READY),
    (0x4F, 0x40, DISABLED),
    (0x6F, 0x21, READY),
    (0x6F, 0x23, SWITCHED_ON),
    (0x6F, 0x27, ENABLED),
    (0x6F, 0x07, QUICK_STOP_ACTIVE),
    (0x4F, 0x0F, FAULT_REACTION),
    (0x4F, 0x08, FAULT),
)

_TOWARDS_ENABLED = {
    FAULT: FAULT_RESET,
    QUICK_STOP_ACTIVE: DISABLE_VOLTAGE,
    DISABLED: SHUTDOWN,
    READY: SWITCH_ON,
    SWITCHED_ON: ENABLE_OPERATION,
}


def state_of(statusword: int) -> str:
    """Returns the state's name in the profile; "undefined" for bits that no state has."""
    for mask, value, state in _PATTERNS:
        if statusword & mask == value:
            return state
    return "undefined"


def towards_enabled(state: str) -> int | None:
    """Returns the controlword of the next step to operation enabled, None where there is only waiting."""
    return _TOWARDS_ENABLED.get(state)
