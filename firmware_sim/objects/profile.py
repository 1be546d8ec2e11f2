"""Objects of the drive profile (CiA 402).

Velocities are encoder counts per second at the wheel, accelerations counts per second squared,
positions counts; defaults are for 66 000 counts a turn.
"""

from __future__ import annotations

from firmware_sim.datatypes import I8, I16, I32, U8, U16, U32
from firmware_sim.entry import Entry, Object, record, var

NO_MODE, PROFILE_POSITION, PROFILE_VELOCITY, HOMING, CYCLIC_POSITION, CYCLIC_VELOCITY = 0, 1, 3, 6, 8, 9
MODES = (NO_MODE, PROFILE_POSITION, PROFILE_VELOCITY, HOMING, CYCLIC_POSITION, CYCLIC_VELOCITY)
POSITION_MODES = frozenset((PROFILE_POSITION, HOMING, CYCLIC_POSITION))
HERE = 37  # homing method: the position now is the home offset
HOMING_METHODS = (17, 18, 19, 20, 21, 22, HERE)  # the others look for a switch

_states: tuple[Object, ...] = (
    var(0x6007, "Abort connection option", I16, "rw", 3, choices=(0, 1, 2, 3)),
    var(0x603F, "Error code", U16, "ro", mappable=True),
    var(0x6040, "Controlword", U16, "rw", mappable=True),
    var(0x6041, "Statusword", U16, "ro", mappable=True),
    var(0x605A, "Quick stop option", I16, "rw", 2, choices=(0, 1, 2, 3, 5, 6, 7)),
    var(0x605B, "Shutdown option", I16, "rw", 0, choices=(0, 1)),
    var(0x605C, "Disable operation option", I16, "rw", 1, choices=(0, 1)),
    var(0x605D, "Halt option", I16, "rw", 1, choices=(1, 2, 3)),
    var(0x605E, "Fault reaction option", I16, "rw", 2, choices=(0, 1, 2, 3)),
    var(0x6060, "Mode of operation", I8, "rw", NO_MODE, choices=MODES, mappable=True),
    var(0x6061, "Mode of operation display", I8, "ro", NO_MODE, mappable=True),
    var(0x6502, "Supported modes", U32, "const", sum(1 << mode - 1 for mode in MODES if mode)),
)

_velocity: tuple[Object, ...] = (
    var(0x606B, "Velocity demand in counts/s", I32, "ro", mappable=True),
    var(0x606C, "Velocity actual in counts/s", I32, "ro", mappable=True),
    var(0x606D, "Velocity window in counts/s", U16, "rw", 1000),
    var(0x606F, "Velocity threshold in counts/s", U16, "rw", 1000),
    var(0x607E, "Polarity", U8, "rw", choices=(0x00, 0x40, 0x80, 0xC0)),
    var(0x607F, "Max velocity in counts/s", U32, "rw", 210_000),
    var(0x6083, "Acceleration in counts/s^2", U32, "rw", 105_000, low=1),
    var(0x6084, "Deceleration in counts/s^2", U32, "rw", 105_000, low=1),
    var(0x6085, "Quick stop deceleration in counts/s^2", U32, "rw", 525_000, low=1),
    var(0x60FF, "Target velocity in counts/s", I32, "rw", mappable=True),
)

_motor: tuple[Object, ...] = (
    var(0x6075, "Motor rated current in mA", U32, "rw", 3_360, low=1),
    var(0x6076, "Rated torque at the wheel in mNm", U32, "rw", 3_238, low=1),
    var(0x6077, "Torque actual in 1/1000 of rated", I16, "ro", mappable=True),
    var(0x6078, "Current actual in 1/1000 of rated", I16, "ro", mappable=True),
    var(0x6079, "DC link voltage in mV", U32, "ro", mappable=True),
    var(0x60FD, "Digital inputs", U32, "ro", mappable=True),
)

# Target torque and its offset are kept for a master that writes them; 6502 claims no torque mode.
_position: tuple[Object, ...] = (
    var(0x6062, "Position demand in counts", I32, "ro", mappable=True),
    var(0x6064, "Position actual in counts", I32, "ro", mappable=True),
    var(0x6065, "Following error window in counts", U32, "rw", 0xFFFFFFFF),
    var(0x6067, "Position window in counts", U32, "rw", 66),
    var(0x6068, "Position window time in ms", U16, "rw", 10),
    var(0x6071, "Target torque in 1/1000 of rated", I16, "rw", mappable=True),
    var(0x607A, "Target position in counts", I32, "rw", mappable=True),
    var(0x607C, "Home offset in counts", I32, "rw"),
    record(
        0x607D,
        "Position limits in counts",
        Entry(1, "Lowest", I32, "rw", -(2**31)),
        Entry(2, "Highest", I32, "rw", 2**31 - 1),
    ),
    var(0x6081, "Profile velocity in counts/s", U32, "rw", 105_000, mappable=True),
    var(0x60F4, "Following error actual in counts", I32, "ro", mappable=True),
    var(0x6098, "Homing method", I8, "rw", HERE, choices=HOMING_METHODS),
    record(
        0x6099,
        "Homing speeds in counts/s",
        Entry(1, "Search for the switch", U32, "rw", 5_000),
        Entry(2, "Search for its edge", U32, "rw", 1_000),
    ),
    var(0x609A, "Homing acceleration in counts/s^2", U32, "rw", 105_000, low=1),
    var(0x60B2, "Torque offset in 1/1000 of rated", I16, "rw", mappable=True),
    record(
        0x60C2,
        "Interpolation period",
        Entry(1, "Units", U8, "rw", 10, 1),
        Entry(2, "Exponent of ten, s", I8, "rw", -3, -6, 0),
    ),
)

PROFILE: tuple[Object, ...] = (*_states, *_velocity, *_motor, *_position)
