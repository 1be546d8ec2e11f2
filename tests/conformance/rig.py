"""A drive on a wire of its own and the whole suite run on it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, cast

from hilbed.can.drive_table import load_table
from hilbed.can.node import Node
from hilbed.conformance.ends import on_the_wire
from hilbed.conformance.result import Result
from hilbed.conformance.subject import Subject
from hilbed.conformance.suite import Terms, perform
from hilbed.drive.desk import Build, Desk

NODE = 5
BITRATE = 500_000


def examined(desk: Desk, armed: bool = True, table: str = "hilbed402") -> dict[str, Result]:
    """Returns the results by their checks."""
    end = on_the_wire(desk, BITRATE)
    subject = Subject(end.link, Node("under test", NODE, load_table(table)))
    results = list(perform(subject, Terms(armed, 1.0, BITRATE, end.exact)))
    found = {result.check: result for result in results}
    assert len(found) == len(results), "two results with one name"
    return found


def drive(break_it: Callable[[Desk], None] | None = None) -> Desk:
    """Returns a drive on a desk that has booted, with something broken if told so."""
    desk = Desk(Build(NODE))
    desk.tick(0, ())
    if break_it is not None:
        break_it(desk)
    return desk


def failed(results: Mapping[str, Result]) -> set[str]:
    """Returns the checks that have failed."""
    return {check for check, result in results.items() if result.status == "fail"}


def objects(desk: Desk) -> dict[int, Any]:
    """Returns the values of the drive's dictionary, by index and sub-index in one number."""
    return cast("dict[int, Any]", desk.firmware._node._values)
