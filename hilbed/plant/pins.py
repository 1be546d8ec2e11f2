"""The pins of the drive's processor: what its firmware gets and gives, in whole numbers."""

from __future__ import annotations

Q15 = 32767


def current(amperes: float) -> int:
    """Converts a current (A) to the I16 of the current amplifier, which clips."""
    return max(-32768, min(32767, round(1000.0 * amperes)))


def supply(volts: float) -> int:
    """Converts the supply (V) to the U8 of its divider, which clips at 63.75 V."""
    return max(0, min(255, round(4.0 * volts)))


def duty(q15: int) -> float:
    """Converts the Q15 of the PWM register to a duty in −1 … 1."""
    return max(-1.0, min(1.0, q15 / Q15))
