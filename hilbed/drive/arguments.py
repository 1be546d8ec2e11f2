"""The options of `hilbed drive`; imports nothing that would make `--help` slow."""

from __future__ import annotations

import argparse

from hilbed.busoptions import add_bus

_NUMBERS = (
    ("inertia", "KGM2", 0.05, "kg m² turned by the shaft at the wheel, besides rotor and gear"),
    ("load", "NM", 0.0, "torque at the wheel against forward rotation"),
    ("friction", "NM", 0.0, "dry friction at the wheel, besides the motor's"),
    ("supply", "V", 24.0, "open-circuit voltage of the supply"),
    ("angle", "RAD", 0.0, "where the shaft stands at first"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds what describes the drive and where it is."""
    parser.add_argument("--node", type=int, required=True, metavar="N", help="node number, 1 to 127")
    add_bus(parser)
    parser.add_argument("--motor", default="re35", metavar="NAME", help="from the catalogue (re35)")
    parser.add_argument("--gear", default="gp32c-33", metavar="NAME", help="from the catalogue, or a ratio")
    for name, unit, default, text in _NUMBERS:
        help = f"{text} ({default:g})"
        parser.add_argument(f"--{name}", type=float, default=default, metavar=unit, help=help)
    text = "shaft's angle from which on its home switch is on (none)"
    parser.add_argument("--switch", type=float, metavar="RAD", help=text)
    parser.add_argument(
        "--table", default="hilbed402", metavar="NAME", help="whose encoder it has (hilbed402)"
    )
    parser.add_argument("--status", action="store_true", help="show in a terminal what it does")
