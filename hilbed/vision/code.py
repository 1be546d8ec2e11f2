"""Where a detector's code is: `package.module:Class`, `file.py` or `file.py:Class`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from hilbed.problems import shorten

_GIVE = ": give package.module:Class, file.py or file.py:Class"


class Code(NamedTuple):
    """A class in an installed module or in a file; name: empty for the only detector of a file."""

    place: str
    name: str

    @property
    def is_file(self) -> bool:
        return self.place.endswith(".py")

    @staticmethod
    def named_by(text: str) -> bool:
        """Tells whether a text could name code at all."""
        return text.endswith(".py") or ":" in text

    def __str__(self) -> str:
        return f"{self.place}:{self.name}" if self.name else self.place


def parse(text: str) -> Code:
    """Returns the place that a text names; raises ValueError where it names none."""
    place, colon, name = text.rpartition(":")
    if not colon:
        place, name = text, ""
    code = Code(place, name)
    if not Code.named_by(text):
        raise ValueError(f"{shorten(text)} is neither a kind of detector nor code{_GIVE}")
    if colon and not name.isidentifier():
        raise ValueError(f"{shorten(text)} does not name a class{_GIVE}")
    if not code.is_file and not all(step.isidentifier() for step in place.split(".")):
        raise ValueError(f"{shorten(text)} does not name a module{_GIVE}")
    return code


def moved(text: str, change: Callable[[Path], Path]) -> str:
    """Returns the same code with its file at another place; a module stays where it is."""
    code = parse(text)
    return str(code._replace(place=str(change(Path(code.place))))) if code.is_file else text
