"""The options of `hilbed conformance`."""

from __future__ import annotations

import argparse
from pathlib import Path

from hilbed.busoptions import add_bus


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds bus, node, drive table and what the checks may do."""
    add_bus(parser)
    parser.add_argument("--node", type=int, required=True, metavar="N", help="node number, 1 to 127")
    parser.add_argument("--drive", default="hilbed402", metavar="TABLE", help="drive table (hilbed402)")
    parser.add_argument("--axis", type=int, default=1, metavar="K", help="of a node with several (1)")
    parser.add_argument("--eds", type=Path, metavar="FILE", help="check its objects against this data sheet")
    parser.add_argument("--arm", action="store_true", help="let the motor turn; else only checks at rest")
    parser.add_argument(
        "--speed",
        type=float,
        default=1.0,
        metavar="RAD/S",
        help="at which it has to turn, for up to 3 s one way (1)",
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="write conformance.json there")
    parser.add_argument("--json", action="store_true", help="print the report as JSON and nothing else")
