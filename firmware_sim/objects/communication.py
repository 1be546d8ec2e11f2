"""Objects of the communication profile (CiA 301), but for the PDOs."""

from __future__ import annotations

from firmware_sim.datatypes import TEXT, U8, U16, U32
from firmware_sim.entry import ARRAY, Entry, Object, record, var

HISTORY = 8  # errors kept in 1003
CONSUMERS = 4  # nodes whose heartbeat can be watched

_history = Object(
    0x1003,
    "Error history",
    ARRAY,
    (
        Entry(0, "Number of errors", U8, "rw"),
        *(Entry(i, f"Error {i}", U32, "ro") for i in range(1, HISTORY + 1)),
    ),
)

COMMUNICATION: tuple[Object, ...] = (
    var(0x1000, "Device type", U32, "const", 0x00020192),
    var(0x1001, "Error register", U8, "ro", mappable=True),
    _history,
    var(0x1005, "SYNC COB-ID", U32, "rw", 0x80),
    var(0x1006, "SYNC period in us", U32, "rw", 10_000),
    var(0x1007, "SYNC window in us", U32, "rw", 0),
    var(0x1008, "Device name", TEXT, "const", "hilbed simulated drive"),
    var(0x1009, "Hardware version", TEXT, "const", "none"),
    var(0x100A, "Software version", TEXT, "const", "1.0"),
    var(0x1014, "EMCY COB-ID", U32, "rw", 0x80, relative=True),
    var(0x1015, "EMCY inhibit time in 100 us", U16, "rw"),
    record(
        0x1016,
        "Heartbeat consumer",
        *(Entry(i, f"Node and time in ms {i}", U32, "rw", 0, 0, 0x7FFFFF) for i in range(1, CONSUMERS + 1)),
        kind=ARRAY,
    ),
    var(0x1017, "Heartbeat producer in ms", U16, "rw"),
    record(
        0x1018,
        "Identity",
        Entry(1, "Vendor", U32, "const", 0),
        Entry(2, "Product code", U32, "const", 0x402),
        Entry(3, "Revision", U32, "const", 0x00010000),
        Entry(4, "Serial number", U32, "const", 0, relative=True),
    ),
    record(
        0x1029,
        "Error behaviour",
        Entry(1, "Communication error", U8, "rw", 0, choices=(0, 1, 2)),
        kind=ARRAY,
    ),
    record(
        0x1200,
        "SDO server",
        Entry(1, "COB-ID client to server", U32, "const", 0x600, relative=True),
        Entry(2, "COB-ID server to client", U32, "const", 0x580, relative=True),
    ),
)
