"""The drive's state machine (CiA 402) as a table: states × commands of the controlword."""

from __future__ import annotations

from enum import IntEnum, auto
from types import MappingProxyType
from typing import Final, NamedTuple


class State(IntEnum):
    """States, each by the bits that show it in the statusword (mask 0x6F)."""

    NOT_READY = 0x00
    SWITCH_ON_DISABLED = 0x40
    READY = 0x21
    SWITCHED_ON = 0x23
    ENABLED = 0x27
    QUICK_STOP = 0x07
    REACTION = 0x0F
    FAULT = 0x08


class Command(IntEnum):
    SHUTDOWN = auto()
    SWITCH_ON = auto()  # in ENABLED the same bits mean "disable operation"
    ENABLE = auto()
    DISABLE_VOLTAGE = auto()
    QUICK_STOP = auto()
    FAULT_RESET = auto()


_S, _C = State, Command
# The numbers are those of the profile's transitions; 0, 1, 13 and 14 happen by themselves.
TRANSITIONS: Final = MappingProxyType(
    {
        (_S.SWITCH_ON_DISABLED, _C.SHUTDOWN): _S.READY,  # 2
        (_S.READY, _C.SWITCH_ON): _S.SWITCHED_ON,  # 3
        (_S.READY, _C.ENABLE): _S.ENABLED,  # 3 and 4 at once
        (_S.READY, _C.QUICK_STOP): _S.SWITCH_ON_DISABLED,  # 7
        (_S.READY, _C.DISABLE_VOLTAGE): _S.SWITCH_ON_DISABLED,  # 7
        (_S.SWITCHED_ON, _C.ENABLE): _S.ENABLED,  # 4
        (_S.SWITCHED_ON, _C.SHUTDOWN): _S.READY,  # 6
        (_S.SWITCHED_ON, _C.QUICK_STOP): _S.SWITCH_ON_DISABLED,  # 10
        (_S.SWITCHED_ON, _C.DISABLE_VOLTAGE): _S.SWITCH_ON_DISABLED,  # 10
        (_S.ENABLED, _C.SWITCH_ON): _S.SWITCHED_ON,  # 5
        (_S.ENABLED, _C.SHUTDOWN): _S.READY,  # 8
        (_S.ENABLED, _C.DISABLE_VOLTAGE): _S.SWITCH_ON_DISABLED,  # 9
        (_S.ENABLED, _C.QUICK_STOP): _S.QUICK_STOP,  # 11
        (_S.QUICK_STOP, _C.DISABLE_VOLTAGE): _S.SWITCH_ON_DISABLED,  # 12
        (_S.QUICK_STOP, _C.ENABLE): _S.ENABLED,  # 16
        (_S.FAULT, _C.FAULT_RESET): _S.SWITCH_ON_DISABLED,  # 15
    }
)

# (mask, bits) of the controlword, most special first.
_PATTERNS = (
    (0x80, 0x80, None),  # bit 7 acts by its rising edge only
    (0x82, 0x00, Command.DISABLE_VOLTAGE),
    (0x86, 0x02, Command.QUICK_STOP),
    (0x87, 0x06, Command.SHUTDOWN),
    (0x8F, 0x07, Command.SWITCH_ON),
    (0x8F, 0x0F, Command.ENABLE),
)
_RESET, HALT = 0x80, 0x100
_DECODED = tuple(next(c for mask, bits, c in _PATTERNS if word & mask == bits) for word in range(256))


def decode(before: int, word: int) -> Command | None:
    """Returns the command in a controlword that follows the controlword `before`."""
    if word & _RESET and not before & _RESET:
        return Command.FAULT_RESET
    return _DECODED[word & 0xFF]


class Ramp(IntEnum):
    """How a drive comes to rest: chopper open, or speed to zero at the rate of an object."""

    COAST = 0
    SLOW = 1  # 6084
    QUICK = 2  # 6085
    FULL = 3  # as fast as the current limit lets it


class Stop(NamedTuple):
    """A way to rest and the state that follows it."""

    ramp: Ramp
    end: State


QUICK_STOPS: Final = MappingProxyType(
    {
        0: Stop(Ramp.COAST, State.SWITCH_ON_DISABLED),
        1: Stop(Ramp.SLOW, State.SWITCH_ON_DISABLED),
        2: Stop(Ramp.QUICK, State.SWITCH_ON_DISABLED),
        3: Stop(Ramp.FULL, State.SWITCH_ON_DISABLED),
        5: Stop(Ramp.SLOW, State.QUICK_STOP),
        6: Stop(Ramp.QUICK, State.QUICK_STOP),
        7: Stop(Ramp.FULL, State.QUICK_STOP),
    }
)

# Object whose option (a Ramp) says how a transition out of ENABLED is made; the others are immediate.
OPTIONS: Final = MappingProxyType({(_S.ENABLED, _C.SHUTDOWN): 0x605B, (_S.ENABLED, _C.SWITCH_ON): 0x605C})
