"""The options that name a python-can bus, the same in every command; imports nothing that is slow."""

from __future__ import annotations

import argparse

_LEFT_OUT = "left out: CAN_INTERFACE, CAN_CHANNEL, CAN_BITRATE or ~/.canrc say"


def add_bus(parser: argparse.ArgumentParser, left_out: str = _LEFT_OUT) -> None:
    """Adds -i, -c and -b as python-can's own programs have them; left_out: what happens without them."""
    parser.add_argument("-i", "--interface", metavar="IFACE", help=f"python-can's name of it ({left_out})")
    parser.add_argument("-c", "--channel", metavar="CHANNEL", help="such as can0, vcan0, /dev/ttyACM0")
    parser.add_argument("-b", "--bitrate", type=int, metavar="BITRATE", help="bit/s, such as 500000")
