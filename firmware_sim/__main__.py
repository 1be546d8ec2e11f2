"""One drive's firmware as a process on any python-can bus: motor and shaft are simulated by a bench.

It ticks when its terminal frame comes (see terminal.py), so it has no clock and waits for the bench as long
as it takes. Ends on SIGINT and SIGTERM with 0; 4: bad arguments, no such bus; 7: the bus has gone.
"""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from typing import NoReturn

from firmware_sim.process import BusLost, NoBus, open_bus, serve
from firmware_sim.terminal import Terminal

REFUSED, LOST = 4, 7


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        self.print_usage(sys.stderr)
        self.exit(REFUSED, f"{self.prog}: {message}\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Serves a node until it is told to end; returns the exit status."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    options = _parser().parse_args(arguments)
    name = f"firmware node {options.node}"
    try:
        with ExitStack() as buses:
            enter = buses.enter_context
            bus = enter(open_bus(options.interface, options.channel, options.bitrate, options.node))
            pins = None
            if options.terminal is not None:
                interface, channel = options.terminal
                pins = enter(open_bus(interface, channel, None, options.node))
            print(f"{name}: ready on {bus.channel_info}", file=sys.stderr, flush=True)
            serve(bus, Terminal(options.node), pins)
    except KeyboardInterrupt:
        return 0
    except NoBus as error:
        print(f"{name}: {error}", file=sys.stderr)
        return REFUSED
    except BusLost as error:
        print(f"{name}: the bus is lost: {error}", file=sys.stderr)
        return LOST


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="python -m firmware_sim", description="The firmware of one simulated drive.")
    parser.add_argument("--node", type=_number, required=True, metavar="N", help="node number, 1 to 127")
    parser.add_argument("-i", "--interface", metavar="IFACE", help="python-can interface")
    parser.add_argument("-c", "--channel", metavar="CHANNEL", help="its channel, such as vcan0")
    parser.add_argument("-b", "--bitrate", type=int, metavar="BIT/S", help="its bit rate")
    text = "interface and channel of the terminal frames, where it is another"
    parser.add_argument("--terminal", nargs=2, metavar=("IFACE", "CHANNEL"), help=text)
    return parser


def _number(text: str) -> int:
    number = int(text)
    if not 1 <= number <= 127:
        raise argparse.ArgumentTypeError(f"{number} is not 1 to 127")
    return number


if __name__ == "__main__":
    sys.exit(main())
