"""The options of `hilbed bus` and what its tools do."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from hilbed.busoptions import add_bus

if TYPE_CHECKING:
    from hilbed.bustools.decoder import Decoder


def add_tools(parser: argparse.ArgumentParser) -> None:
    """Adds scan, monitor and dbc as sub-commands; `options.tool` is what does them."""
    tools = parser.add_subparsers(metavar="TOOL", required=True, parser_class=type(parser))

    text = "list the nodes on a bus with their identity and state, by reading objects only"
    scan = tools.add_parser("scan", help=text, description=text.capitalize() + ".")
    add_bus(scan)
    scan.add_argument("--listen", type=float, default=1.0, metavar="S", help="for heartbeats, before (1)")
    scan.add_argument("--json", action="store_true", help="print the nodes as JSON")
    scan.set_defaults(tool=_scan)

    text = "show decoded frames live; Ctrl-C ends it"
    monitor = tools.add_parser("monitor", help=text, description=text.capitalize() + ".")
    add_bus(monitor)
    by = monitor.add_mutually_exclusive_group()
    by.add_argument("--run", metavar="RUN", help="decode by the drives of a run folder or a scenario")
    by.add_argument("--dbc", type=Path, metavar="FILE", help="decode by a DBC file")
    by.add_argument("--drive", metavar="TABLE", help="decode every node by a drive table (hilbed402)")
    monitor.add_argument("--for", type=float, dest="length", metavar="S", help="end after so many seconds")
    monitor.set_defaults(tool=_monitor)

    text = "print the DBC of the PDO mapping that a scenario or a run folder has"
    dbc = tools.add_parser("dbc", help=text, description=text[0].upper() + text[1:] + ".")
    dbc.add_argument("scenario", metavar="SCENARIO", help="a bundled scenario, a YAML file or a run folder")
    dbc.set_defaults(tool=_dbc)


def bus(options: argparse.Namespace) -> int:
    """Does `hilbed bus`; returns the exit status. Raises ScenarioError, BusError."""
    status: int = options.tool(options)
    return status


def _scan(options: argparse.Namespace) -> int:
    import json

    from hilbed.bustools.live import open_bus
    from hilbed.bustools.scan import scan, table_of
    from hilbed.clock import nanos

    listen = _length("--listen", options.listen)
    with open_bus(options.interface, options.channel, options.bitrate) as live:
        found = scan(live, live.pump, nanos(listen), live.now)
    print(json.dumps([node.as_dict() for node in found], indent=2) if options.json else table_of(found))
    return 0


def _monitor(options: argparse.Namespace) -> int:
    import sys

    from hilbed.bustools.live import open_bus
    from hilbed.bustools.monitor import Lines, Screen, monitor, terminal_size
    from hilbed.clock import nanos
    from hilbed.console import stop_on_signal

    length = None if options.length is None else nanos(_length("--for", options.length))
    decoder = _decoder(options)
    with stop_on_signal() as stop, open_bus(options.interface, options.channel, options.bitrate) as live:
        out = sys.stdout
        display = Screen(decoder, out, terminal_size) if out.isatty() else Lines(decoder, out)
        monitor(live, display, lambda: stop.signal is not None, length)
    return 0


def _decoder(options: argparse.Namespace) -> Decoder:
    from hilbed.bustools.decoder import Decoder, read_dbc
    from hilbed.bustools.drives import nodes_in
    from hilbed.can.dbc import database
    from hilbed.can.drive_table import named_table

    if options.dbc is not None:
        return Decoder(read_dbc(options.dbc))
    if options.run is not None:
        return Decoder(database(nodes_in(options.run)))
    return Decoder(database([]), named_table(options.drive or "hilbed402"))


def _dbc(options: argparse.Namespace) -> int:
    from hilbed.bustools.drives import nodes_in
    from hilbed.can.dbc import dbc

    print(dbc(nodes_in(options.scenario)), end="")
    return 0


def _length(name: str, value: float) -> float:
    from hilbed.types import ScenarioError

    if not 0 <= value <= 86400:
        raise ScenarioError(f"{name} {value:g}: 0 to 86400 s")
    return value
