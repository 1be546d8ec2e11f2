"""Switching the mode of operation."""

from __future__ import annotations

from collections.abc import Iterator

from hilbed.can.sdo import SdoError
from hilbed.clock import MILLISECOND, seconds
from hilbed.conformance.result import Result, told, unsupported
from hilbed.conformance.subject import Subject

_PROFILE_MODES = (1, 2, 3, 4, 6, 7, 8, 9, 10)


def modes(subject: Subject) -> Iterator[Result]:
    """Each mode of the table is shown after it was written; one that is not supported is not shown."""
    if not subject.has("mode_display"):
        yield unsupported("modes", "no 6061")
        return
    for name, number in subject.node.table.modes.items():
        begun = subject.link.t
        subject.use_mode(name)
        took = seconds(subject.link.t - begun)
        yield told(f"modes/{name}", True, f"mode {number} is shown", 1e3 * took, "ms")
    if subject.has("modes"):
        yield from _unsupported(subject)


def _unsupported(subject: Subject) -> Iterator[Result]:
    supported = subject.read("modes")
    stranger = next((n for n in _PROFILE_MODES if not supported >> n - 1 & 1), None)
    if stranger is None:
        return
    try:
        subject.write("mode", stranger)
    except SdoError as error:
        yield told("modes/unsupported one", True, f"mode {stranger}: abort {error.code:08X}")
        return
    subject.link.pause(50 * MILLISECOND)
    shown = subject.read("mode_display")
    yield told("modes/unsupported one", shown != stranger, f"mode {stranger} was taken, {shown} is shown")
