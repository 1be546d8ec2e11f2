"""`hilbed conformance`: every check on one drive, told as it goes."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

from hilbed.can.drive_table import DriveTable, named_table
from hilbed.can.node import Node
from hilbed.conformance import report
from hilbed.conformance.eds import read_eds
from hilbed.conformance.ends import WIRE, End, live, simulated
from hilbed.conformance.result import Result
from hilbed.conformance.subject import Subject
from hilbed.conformance.suite import Terms, perform
from hilbed.record.folder import write_whole
from hilbed.types import ScenarioError

PASSED, FAILED = 0, 1
FASTEST = 100.0  # rad/s
DEFAULT_BITRATE = 500_000
REPORT = "conformance.json"


def main(options: argparse.Namespace) -> int:
    """Does `hilbed conformance`; returns the exit status. Raises ScenarioError, BusError."""
    node = _node(options)
    bitrate = options.bitrate or DEFAULT_BITRATE
    promises = [] if options.eds is None else read_eds(options.eds)
    _check_out(options.out)
    results: list[Result] = []
    with _end(options, node, bitrate) as end:
        about = {"node": node.id, "axis": node.axis, "drive": node.table.name, "bus": end.name}
        terms = Terms(options.arm, options.speed, bitrate, end.exact, promises)
        with closing(perform(Subject(end.link, node), terms)) as found:  # stops the drive before the bus goes
            for result in found:
                results.append(result)
                if not options.json:
                    print(report.line(result), flush=True)
    about |= {"armed": options.arm, "speed": options.speed}
    _tell(results, about, options)
    return PASSED if report.passed(results) else FAILED


def _node(options: argparse.Namespace) -> Node:
    table = named_table(options.drive)
    problems = []
    if not 1 <= options.node <= 127:
        problems.append(f"--node {options.node}: a node's number is 1 to 127")
    if not 1 <= options.axis <= table.axes:
        problems.append(f"--axis {options.axis}: {table.name} has {table.axes}")
    if not 0 < abs(options.speed) <= FASTEST:
        problems.append(f"--speed {options.speed:g}: up to {FASTEST:g} rad/s, and not 0")
    if problems:
        raise ScenarioError("\n".join(problems))
    return subject_node(options.node, table, options.axis)


def subject_node(number: int, table: DriveTable, axis: int = 1) -> Node:
    """Returns the drive under test, in the mode that its table names first."""
    return Node("under test", number, table, next(iter(table.modes)), axis=axis)


@contextmanager
def _end(options: argparse.Namespace, node: Node, bitrate: int) -> Iterator[End]:
    if options.interface == WIRE:
        yield simulated(node, bitrate)
        return
    with live(options.interface, options.channel, options.bitrate) as end:
        yield end


def _check_out(folder: Path | None) -> None:
    """Finds before the drive is touched whether the report can be written."""
    if folder is None:
        return
    if (folder / REPORT).exists():
        raise ScenarioError(f"{folder / REPORT} exists; give another folder with --out")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ScenarioError(f"{folder}: {error.strerror}; give another folder with --out") from error


def _tell(results: list[Result], about: dict[str, Any], options: argparse.Namespace) -> None:
    text = json.dumps(report.document(results, about), indent=2)
    if options.out is not None:
        write_whole(options.out / REPORT, text.encode())
    print(text if options.json else report.summary(results))
