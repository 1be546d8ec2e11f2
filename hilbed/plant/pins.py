"""The pins of the drive's processor: what its firmware gets and gives, in whole numbers."""

from __future__ import annotations

Q15 = 32767


def current(amperes: float) -> int:
    """Converts a current (A) to the I16 of the current amplifier, which clips."""
    if not -32.768 <= amperes <= 32.767:
        return 32767 if amperes > 0.0 else -32768
    return round(1000.0 * amperes)


def supply(volts: float) -> int:
    """Converts the supply (V) to the U8 of its divider, which clips at 63.75 V."""
    if not 0.0 <= volts <= 63.75:
        return 255 if volts > 0.0 else 0
    return round(4.0 * volts)


def duty(q15: int) -> float:
    """Converts the Q15 of the PWM register to a duty in −1 … 1."""
    return q15 / Q15 if q15 >= -Q15 else -1.0


def speed(micro: int) -> float:
    """Converts µrad/s to rad/s."""
    return micro * 1e-6
