"""Colours of beacons, by name, and of everything else, by name or as red, green, blue."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator

from hilbed.spec import Fraction, Listed

Colour = tuple[float, float, float]

COLOURS: dict[str, Colour] = {
    "red": (1.0, 0.0, 0.0),
    "orange": (1.0, 0.5, 0.0),
    "yellow": (1.0, 1.0, 0.0),
    "lime": (0.5, 1.0, 0.0),
    "green": (0.0, 1.0, 0.0),
    "spring": (0.0, 1.0, 0.5),
    "cyan": (0.0, 1.0, 1.0),
    "azure": (0.0, 0.5, 1.0),
    "blue": (0.0, 0.0, 1.0),
    "violet": (0.5, 0.0, 1.0),
    "magenta": (1.0, 0.0, 1.0),
    "rose": (1.0, 0.0, 0.5),
}
"""Those of beacons: 30° apart in hue."""

GREYS: dict[str, Colour] = {"white": (1.0, 1.0, 1.0), "grey": (0.6, 0.6, 0.6), "black": (0.05, 0.05, 0.05)}

BeaconColour = Literal[
    "red", "orange", "yellow", "lime", "green", "spring",
    "cyan", "azure", "blue", "violet", "magenta", "rose",
]  # fmt: skip


def _named(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    known = COLOURS | GREYS
    if value not in known:
        raise ValueError(f"{value!r} is none of {', '.join(known)}; or give [red, green, blue], each 0…1")
    return known[value]


AnyColour = Annotated[Listed[tuple[Fraction, Fraction, Fraction]], BeforeValidator(_named)]
"""`red`, `grey` or `[0.8, 0.1, 0.1]`."""
