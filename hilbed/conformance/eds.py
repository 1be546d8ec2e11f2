"""What an EDS promises: the objects of a device with their types and access (CiA 306)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from configparser import ConfigParser, Error, MissingSectionHeaderError, ParsingError
from pathlib import Path
from typing import NamedTuple

from hilbed.problems import shorten
from hilbed.types import ScenarioError

_SECTION = re.compile("([0-9A-F]{4})(?:sub([0-9A-F]{1,2}))?", re.IGNORECASE)
_BYTES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 1, 6: 2, 7: 4, 8: 4, 0x10: 3, 0x11: 8, 0x15: 8, 0x16: 3, 0x1B: 8}
"""Of each numeric data type; others have any length."""
_READABLE = ("ro", "rw", "rwr", "rww", "const")


class Promise(NamedTuple):
    """A readable entry: number of its object, sub-index, size in bytes (None where any will do)."""

    object: int
    sub: int
    size: int | None


def read_eds(path: Path) -> list[Promise]:
    """Returns the readable entries of an EDS; ScenarioError with file and line where it does not parse."""
    parser = ConfigParser(interpolation=None, strict=True)
    try:
        parser.read_string(path.read_text(encoding="latin-1"), source=str(path))
    except OSError as error:
        raise ScenarioError(f"{path}: {error.strerror}") from None
    except MissingSectionHeaderError as error:
        raise ScenarioError(f"{path}:{error.lineno}: not in a [section]: {shorten(error.line)}") from None
    except ParsingError as error:
        raise ScenarioError(
            "\n".join(
                f"{path}:{line}: neither [section] nor key=value: {shorten(what)}"
                for line, what in error.errors
            )
        ) from None
    except Error as error:
        line = getattr(error, "lineno", None)
        raise ScenarioError(f"{path}:{line or 1}: {' '.join(error.message.split())}") from None
    promises = list(_promises(path, parser))
    if not promises:
        raise ScenarioError(f"{path}: describes no object that can be read: is it an EDS?")
    return promises


def _promises(path: Path, parser: ConfigParser) -> Iterator[Promise]:
    for name in parser.sections():
        match = _SECTION.fullmatch(name)
        section = parser[name]
        if match is None or "DataType" not in section:
            continue
        if section.get("AccessType", "").strip().lower() in _READABLE:
            kind = _number(path, name, section["DataType"])
            yield Promise(int(match[1], 16), int(match[2] or "0", 16), _BYTES.get(kind))


def _number(path: Path, section: str, text: str) -> int:
    try:
        return int(text.strip(), 0)
    except ValueError:
        raise ScenarioError(f"{path}: [{section}] DataType={text!r} is no number") from None
