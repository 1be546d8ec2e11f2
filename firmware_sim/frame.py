"""One CAN frame, as the firmware's CAN controller hands it over."""

from __future__ import annotations

from typing import NamedTuple, Protocol


class Frame(NamedTuple):
    """A classic CAN frame: identifier, up to eight bytes, 29-bit and remote flags."""

    id: int
    data: bytes = b""
    extended: bool = False
    remote: bool = False


class AnyFrame(Protocol):
    """Whatever has the four fields of a frame: the bench's own frames are accepted as they are."""

    @property
    def id(self) -> int: ...

    @property
    def data(self) -> bytes: ...

    @property
    def extended(self) -> bool: ...

    @property
    def remote(self) -> bool: ...
