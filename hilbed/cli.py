"""The command line: human text on stderr, results on stdout, exit statuses as the contract says."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

from hilbed import __version__
from hilbed.types import ScenarioError

PASSED, FAILED, INTERRUPTED, INTERNAL, REFUSED, BUS = 0, 1, 2, 3, 4, 7


class _Parser(argparse.ArgumentParser):
    """An argparse parser whose errors are found before the first cycle, so they end with 4."""

    def error(self, message: str) -> NoReturn:
        self.print_usage(sys.stderr)
        self.exit(REFUSED, f"{self.prog}: {message}\n")


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Runs the command that the arguments name and exits with its status."""
    from hilbed.console import quiet_pipe

    options = _parser().parse_args(arguments)
    with quiet_pipe():
        try:
            status = options.command(options)
        except ScenarioError as error:
            print(error, file=sys.stderr)
            status = REFUSED
        except KeyboardInterrupt:
            print("interrupted", file=sys.stderr)
            status = INTERRUPTED
    sys.exit(status)


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="hilbed", description="A bench for wheeled robots that behaves like a hardware-in-the-loop rig.")
    parser.add_argument("--version", action="version", version=f"hilbed {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True, parser_class=_Parser)
    for add in (_add_run, _add_sweep, _add_list, _add_check, _add_report, _add_fit, _add_bench):
        add(commands)
    return parser
