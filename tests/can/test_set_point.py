"""The controller's half of PP's handshake, and with the firmware's own half of it."""

from __future__ import annotations

import struct
from math import tau

import cantools
import pytest

from hilbed.can.axis import STATUS
from hilbed.can.cia402 import ENABLE_OPERATION, QUICK_STOP
from hilbed.can.dbc import dbc
from hilbed.can.drive_table import load_table
from hilbed.can.node import Node
from hilbed.can.position_axis import PositionAxis
from hilbed.can.set_point import ACKNOWLEDGED, AT_ONCE, NEW, SetPointStation
from hilbed.can.specs import resolve, with_table
from hilbed.can.stations import stations
from tests.can.rig import COUNTS

NODE = Node("steering", 2, load_table("hilbed402-pp"), "pp")
OFFER = ENABLE_OPERATION | NEW | AT_ONCE


class Told:
    """A station that is asked for angles in counts, cycle by cycle."""

    def __init__(self) -> None:
        self.axis = PositionAxis(NODE)
        self.station = SetPointStation([self.axis])

    def cycle(self, counts: int, acknowledged: bool) -> tuple[int, int]:
        self.axis.values[STATUS] = 0x27 | ACKNOWLEDGED * acknowledged
        self.axis.ask(counts / COUNTS * tau)
        (frame,) = self.station.orders()
        assert frame.id == 0x202
        word, target = struct.unpack("<Hi", frame.data)
        return word, target


def test_a_target_is_offered_until_it_is_acknowledged() -> None:
    told = Told()
    assert told.cycle(100, False) == (OFFER, 100)
    assert told.cycle(200, False) == (OFFER, 100)  # not heard yet: it may have been lost
    assert told.cycle(300, True) == (ENABLE_OPERATION, 100)
    assert told.cycle(300, True) == (ENABLE_OPERATION, 100)  # the drive has not let go
    assert told.cycle(300, False) == (OFFER, 300)
    assert told.cycle(300, True) == (ENABLE_OPERATION, 300)
    assert told.cycle(300, False) == (ENABLE_OPERATION, 300)  # nothing new


def test_a_stop_is_told_at_once_and_for_good() -> None:
    told = Told()
    told.cycle(100, False)
    *_, order = told.station.stop()
    assert struct.unpack("<Hi", order.data) == (QUICK_STOP, 100)
    assert told.cycle(500, False)[0] == QUICK_STOP


def test_the_mode_chooses_the_station_and_the_table() -> None:
    assert type(stations([PositionAxis(NODE)])[0]) is SetPointStation
    csp = resolve({}, ("traction", "steering"))[1]
    assert type(stations([PositionAxis(csp)])[0]) is not SetPointStation
    assert with_table("steering", {"mode": "pp"})["table"] == "hilbed402-pp"
    assert with_table("steering", {"mode": "pv"})["table"] == "hilbed402-csp"  # which refuses it


def test_its_frames_are_in_the_dbc() -> None:
    database = cantools.database.load_string(dbc([NODE]), "dbc")
    order = database.decode_message(0x202, struct.pack("<Hi", OFFER, 16_500))
    assert order == {"controlword": OFFER, "target_position": pytest.approx(tau / 4)}
    assert database.decode_message(0x482, b"\x27\x16") == {"statusword": 0x1627}
    shown = database.decode_message(0x382, struct.pack("<bHI", 1, 0, 24_000))
    assert (shown["mode_display"], shown["supply"]) == ("pp", 24.0)


def test_the_table_is_the_other_one_but_for_what_it_says() -> None:
    one, other = load_table("hilbed402-pp"), load_table("hilbed402-csp")
    assert {key for key in type(one).model_fields if getattr(one, key) != getattr(other, key)} == {
        "name",
        "pdos",
        "modes",
    }
    assert one.modes["pp"] == 1
    assert one.positions
    assert one.target == "target_position"
