"""Who wins the bus: the frame with the first dominant bit where another one is recessive."""

from __future__ import annotations

from functools import lru_cache


@lru_cache(maxsize=4096)
def arbitration(identifier: int, extended: bool, remote: bool) -> int:
    """Returns the 32 arbitration bits as a number: the lower one wins the bus (dominant is 0).

    Standard: identifier, RTR, IDE = 0. Extended: base, SRR = 1, IDE = 1, extension, RTR. So data beats
    remote, and a standard frame beats an extended one with the same base.
    """
    if not extended:
        return identifier << 21 | remote << 20
    return (identifier >> 18) << 21 | 0b11 << 19 | (identifier & 0x3FFFF) << 1 | remote
