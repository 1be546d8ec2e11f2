"""What a CANopen node needs of the device behind it."""

from __future__ import annotations

from typing import Protocol

from firmware_sim.errors import ErrorCode


class Application(Protocol):
    """A device that shares its object dictionary's values with the node."""

    @property
    def faulted(self) -> bool: ...

    def reset(self) -> None:
        """Starts as at power-on; the dictionary holds its defaults."""
        ...

    def refresh(self) -> None:
        """Writes actual values into the dictionary: somebody is about to read them."""
        ...

    def changed(self, index: int) -> None:
        """A value of this object was written over the bus."""
        ...

    def disconnected(self, code: ErrorCode) -> None:
        """The master has gone, or has taken the node out of operation."""
        ...
