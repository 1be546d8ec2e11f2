"""Manufacturer objects: what is tuned once and never part of a PDO. SI units at the wheel unless said."""

from __future__ import annotations

from firmware_sim.datatypes import REAL32, TEXT, U8, U16, U32
from firmware_sim.entry import Entry, Object, record, var

VARIABLE_STRUCTURE, FIXED_PI, RELAY = 0, 1, 2

# Slimane et al. 2014, in duty per rad/s at the wheel, for a 90 W motor of 24 V behind a gear of 33.
_loop = record(
    0x2010,
    "Speed loop",
    Entry(1, "Kind: 0 variable structure, 1 fixed PI, 2 relay", U8, "rw", VARIABLE_STRUCTURE, 0, 2),
    Entry(2, "Proportional gain kp0", REAL32, "rw", 0.11, 0.0, 100.0),
    Entry(3, "Integral gain ki0 in 1/s", REAL32, "rw", 1.5, 0.0, 1000.0),
    Entry(4, "Sliding slope lambda in s", REAL32, "rw", 0.03, 0.0, 1.0),
    Entry(5, "Band start in rad/s", REAL32, "rw", 0.05, 0.0, 100.0),
    Entry(6, "Band width in rad/s", REAL32, "rw", 0.2, 0.001, 100.0),
    Entry(7, "Rise of kp in the band", REAL32, "rw", 3.0, 0.0, 100.0),
    Entry(8, "Rise of ki in the band", REAL32, "rw", 15.0, 0.0, 100.0),
    Entry(9, "Error at which ki no longer rises in rad/s", REAL32, "rw", 2.0, 0.001, 100.0),
    Entry(10, "Derivative filter in s", REAL32, "rw", 0.005, 0.0, 1.0),
    Entry(11, "Anti-windup in 1/s", REAL32, "rw", 20.0, 0.0, 500.0),
    Entry(12, "Speed filter in s", REAL32, "rw", 0.002, 0.0, 1.0),
)

TUNING: tuple[Object, ...] = (
    var(0x2000, "Label", TEXT, "rw", ""),
    var(0x2001, "Encoder counts per wheel turn", U32, "rw", 66_000, low=1),
    var(0x2002, "SYNC timeout in ms, 0 off", U16, "rw"),
    var(0x2003, "Chopper frequency in Hz", U32, "rw", 20_000, low=1_000, high=200_000),
    _loop,
    record(
        0x2011,
        "Relay sliding mode",
        Entry(1, "Amplitude in duty", REAL32, "rw", 0.15, 0.0, 1.0),
        Entry(2, "Boundary layer in rad/s", REAL32, "rw", 0.3, 0.001, 100.0),
        Entry(3, "Integral gain in 1/s", REAL32, "rw", 1.5, 0.0, 1000.0),
    ),
    record(
        0x2012,
        "Motor model",
        Entry(1, "Terminal resistance in ohm", REAL32, "rw", 0.583, 0.001, 1000.0),
        Entry(2, "Back-EMF at the wheel in V s", REAL32, "rw", 0.9636, 0.0, 1000.0),
    ),
    record(
        0x2013,
        "Limits",
        Entry(1, "Current limit in A", REAL32, "rw", 10.0, 0.0, 32.0),
        Entry(2, "Overcurrent trip in A", REAL32, "rw", 20.0, 0.0, 32.7),
        Entry(3, "Undervoltage trip in V", REAL32, "rw", 12.0, 0.0, 60.0),
        Entry(4, "Reference slew in CSV in rad/s^2, 0 off", REAL32, "rw", 0.0, 0.0, 100000.0),
    ),
    var(0x2014, "Position loop gain in 1/s", REAL32, "rw", 20.0, low=0.0, high=500.0),
    var(0x2015, "Homing time-out in ms, 0 off", U16, "rw", 10_000),
)
