"""PDO communication and mapping objects: four each way, as in the predefined connection set."""

from __future__ import annotations

from firmware_sim.datatypes import U8, U16, U32
from firmware_sim.entry import RECORD, Entry, Object

PDOS = 4  # each way
MAPPED = 8  # entries of one PDO: eight single bytes
OFF = 1 << 31
NO_REMOTE = 1 << 30

RX_PARAMETERS, RX_MAPPING, TX_PARAMETERS, TX_MAPPING = 0x1400, 0x1600, 0x1800, 0x1A00


def _mapped(index: int, bits: int) -> int:
    return index << 16 | bits


CONTROL_TARGET = (_mapped(0x6040, 16), _mapped(0x60FF, 32))
STATUS_SPEED_TORQUE = (_mapped(0x6041, 16), _mapped(0x606C, 32), _mapped(0x6077, 16))
POSITION_CURRENT = (_mapped(0x6064, 32), _mapped(0x6078, 16))
MODE_ERROR_VOLTAGE = (_mapped(0x6061, 8), _mapped(0x603F, 16), _mapped(0x6079, 32))


def _mapping(index: int, name: str, mapped: tuple[int, ...]) -> Object:
    padded = (*mapped, *(0 for _ in range(MAPPED - len(mapped))))
    entries = (Entry(i + 1, f"Entry {i + 1}", U32, "rw", value) for i, value in enumerate(padded))
    return Object(index, name, RECORD, (Entry(0, "Number of entries", U8, "rw", len(mapped)), *entries))


def _parameters(index: int, name: str, *entries: Entry) -> Object:
    count = Entry(0, "Highest sub-index supported", U8, "const", entries[-1].sub)
    return Object(index, name, RECORD, (count, *entries))


def _receive(number: int, kind: int, mapped: tuple[int, ...]) -> tuple[Object, Object]:
    cob = 0x200 + 0x100 * number | (0 if mapped else OFF)
    return (
        _parameters(
            RX_PARAMETERS + number,
            f"RPDO{number + 1} parameters",
            Entry(1, "COB-ID", U32, "rw", cob, relative=True),
            Entry(2, "Transmission type", U8, "rw", kind),
        ),
        _mapping(RX_MAPPING + number, f"RPDO{number + 1} mapping", mapped),
    )


def _transmit(number: int, kind: int, event: int, mapped: tuple[int, ...]) -> tuple[Object, Object]:
    cob = 0x180 + 0x100 * number | NO_REMOTE | (0 if mapped else OFF)
    return (
        _parameters(
            TX_PARAMETERS + number,
            f"TPDO{number + 1} parameters",
            Entry(1, "COB-ID", U32, "rw", cob, relative=True),
            Entry(2, "Transmission type", U8, "rw", kind),
            Entry(3, "Inhibit time in 100 us", U16, "rw"),
            Entry(5, "Event timer in ms", U16, "rw", event),
        ),
        _mapping(TX_MAPPING + number, f"TPDO{number + 1} mapping", mapped),
    )


PDO: tuple[Object, ...] = (
    *_receive(0, 1, CONTROL_TARGET),
    *_receive(1, 255, ()),
    *_receive(2, 255, ()),
    *_receive(3, 255, ()),
    *_transmit(0, 1, 0, STATUS_SPEED_TORQUE),
    *_transmit(1, 1, 0, POSITION_CURRENT),
    *_transmit(2, 255, 100, MODE_ERROR_VOLTAGE),
    *_transmit(3, 255, 0, ()),
)
