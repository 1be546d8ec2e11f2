"""Identifiers of CANopen's predefined connection set: a function code plus the node's number."""

from __future__ import annotations

from hilbed.types import Frame

NMT = 0x000
SYNC = 0x080
EMERGENCY = 0x080
SDO_ANSWER = 0x580
SDO_REQUEST = 0x600
HEARTBEAT = 0x700

CONTROLLER_ID = 127
"""The node number under which the controller sends its heartbeat."""

SYNC_FRAME = Frame(SYNC)
