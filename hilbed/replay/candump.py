"""Logs in the format of `candump -L`: `(seconds.fraction) channel ID#DATA`, one frame a line."""

from __future__ import annotations

import re
from pathlib import Path

from hilbed.clock import SECOND
from hilbed.problems import shorten
from hilbed.types import Frame, Nanos, Received, ScenarioError

MOST_PROBLEMS = 20
_LINE = re.compile(r"\((\d{1,12})\.(\d{1,9})\) \S+ ([^#\s]+)#(\S*)(?: [RT])?")
_ERROR_FRAME, _EXTENDED, _STANDARD = 0x20000000, 0x1FFFFFFF, 0x7FF


def read_log(path: Path) -> list[Received]:
    """Reads a log, error frames left out; t is the log's own time in ns, to the microsecond as a rule.

    Raises ScenarioError with file, line and content of every line that is none (the first twenty).
    """
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        raise ScenarioError(f"{path}: {error.strerror}") from None
    frames: list[Received] = []
    problems: list[str] = []
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        try:
            received = parse(line)
        except ValueError as error:
            problems.append(f"{path}:{number}: {error}: {shorten(line)}")
            continue
        if received is not None:
            frames.append(received)
    if problems:
        more = len(problems) - MOST_PROBLEMS
        raise ScenarioError("\n".join(problems[:MOST_PROBLEMS] + [f"… and {more} more"] * (more > 0)))
    return frames


def parse(line: str) -> Received | None:
    """Returns the frame of a line, None for an error frame; ValueError, with a reason, for anything else."""
    match = _LINE.fullmatch(line.rstrip())
    if match is None:
        raise ValueError("not a line of candump -L, `(seconds.fraction) channel ID#DATA`")
    whole, fraction, identifier, content = match.groups()
    if not re.fullmatch("[0-9A-Fa-f]{3}|[0-9A-Fa-f]{8}", identifier):
        raise ValueError("the identifier has neither 3 nor 8 hexadecimal digits")
    number, extended = int(identifier, 16), len(identifier) == 8
    if extended and number & _ERROR_FRAME:
        return None
    if number > (_EXTENDED if extended else _STANDARD):
        raise ValueError("the identifier is larger than any of a CAN frame")
    t: Nanos = int(whole) * SECOND + int(fraction.ljust(9, "0"))
    if content[:1] == "R":
        return Received(t, Frame(number, bytes(_remote_length(content[1:])), extended, True))
    return Received(t, Frame(number, _data(content), extended))


def _remote_length(text: str) -> int:
    if text and text not in "012345678":
        raise ValueError("a remote frame asks for 0 to 8 bytes")
    return int(text or 0)


def _data(text: str) -> bytes:
    if text[:1] == "#":
        raise ValueError("a CAN FD frame, which no drive of this bench sends")
    if not re.fullmatch("(?:[0-9A-Fa-f]{2}){0,8}", text):
        raise ValueError("the data are not up to 8 bytes of two hexadecimal digits")
    return bytes.fromhex(text)
