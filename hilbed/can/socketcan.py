"""What Linux says of a SocketCAN interface before it is opened: down, or at another bit rate."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

_UP = 1  # IFF_UP
_PATIENCE = 5.0  # s


def complaint(channel: str, bitrate: int | None) -> str:
    """Returns what is wrong with an interface, with what would do; empty where nothing is known to be.

    bitrate: bit/s that the bus is meant to have; vcan has none, so it always fits.
    """
    flags = Path("/sys/class/net") / channel / "flags"
    if not flags.is_file():
        return ""  # the socket will tell
    if not int(flags.read_text(), 16) & _UP:
        return f"is down; `ip link set {channel} up` brings it up"
    actual = _bitrate(channel)
    if None not in (actual, bitrate) and actual != bitrate:
        return f"runs at {actual} bit/s, not at {bitrate}; give -b {actual}, or set the interface"
    return ""


def _bitrate(channel: str) -> int | None:
    """Returns the bit rate that `ip` shows, None where it shows none or is not there."""
    command = ["ip", "-json", "-details", "link", "show", "dev", channel]
    try:
        shown = subprocess.run(command, capture_output=True, timeout=_PATIENCE, check=True).stdout
        return int(json.loads(shown)[0]["linkinfo"]["info_data"]["bittiming"]["bitrate"])
    except (OSError, subprocess.SubprocessError, ValueError, LookupError, TypeError):
        return None
