"""What has gone over an adapter."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class Counts:
    """Frames sent, dropped (not sent) and received; error frames; received ones that are no CAN 2.0 frame."""

    sent: int = 0
    dropped: int = 0
    received: int = 0
    errors: int = 0
    malformed: int = 0
