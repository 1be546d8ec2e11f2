"""What a foreign detector gives back: made plain where it runs, judged where it is used."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite, nan, pi
from operator import index
from typing import Any

from hilbed.problems import nearest, shorten
from hilbed.vision.lens import Lens
from hilbed.vision.seams import Detection

MOST = 1000
"""Detections a frame; more of them are a mistake."""

Row = list[Any]
_FIELDS = Detection._fields
_NEEDED = ("azimuth", "std", "column")
_EDGE = 0.5  # pixels beyond the centres of the outer ones


def plain(returned: object) -> list[Row]:
    """Returns azimuth, std, column, beacon, row of each detection as plain numbers, None where not stated.

    Takes a list or tuple of Detection, of tuples in the order of its fields, or of dicts of them. Raises
    ValueError for anything else.
    """
    if not isinstance(returned, list | tuple) or isinstance(returned, Detection):
        raise ValueError(f"detect returned {shorten(returned)}, not a list of detections")
    if len(returned) > MOST:
        raise ValueError(f"detect returned {len(returned)} detections, more than {MOST}")
    return [_row(one) for one in returned]


def _row(one: object) -> Row:
    fields = _fields(one)
    missing = [name for name in _NEEDED if fields.get(name) is None]
    if missing:
        raise ValueError(f"a detection states no {' and no '.join(missing)}: {shorten(one)}")
    return [_plain(name, fields.get(name)) for name in _FIELDS]


def _fields(one: object) -> dict[str, Any]:
    if isinstance(one, dict):
        for key in one:
            if key not in _FIELDS:
                meant = nearest(str(key), _FIELDS)
                raise ValueError(f"a detection has an unknown field {shorten(key)}{meant}")
        return one
    if isinstance(one, list | tuple) and len(one) <= len(_FIELDS):
        return dict(zip(_FIELDS, one, strict=False))
    raise ValueError(f"{shorten(one)} is no detection: give ({', '.join(_FIELDS)}), the last two at will")


def _plain(name: str, value: Any) -> float | int | None:
    if value is None:
        return None
    try:
        if isinstance(value, str | bytes | bool):
            raise TypeError
        return index(value) if name == "beacon" else float(value)
    except (TypeError, ValueError, OverflowError):
        kind = "an index" if name == "beacon" else "a number"
        raise ValueError(f"{name} is {shorten(value)}, not {kind}") from None


def checked(rows: Sequence[Row], lens: Lens, beacons: int) -> list[Detection]:
    """Returns rows of `plain` as detections, from left to right; beacons: how many there are.

    Raises ValueError where one is not finite, has no positive standard deviation, lies out of the image or
    names a beacon that is not there.
    """
    found = [_detection(row) for row in rows]
    right, left = lens.span
    for one in found:
        if not (isfinite(one.azimuth) and isfinite(one.std) and isfinite(one.column)):
            raise ValueError(f"not finite: {_told(one)}")
        if not 0.0 < one.std <= pi:
            raise ValueError(f"std is {one.std:g} rad, it must be positive and at most π: {_told(one)}")
        if not right - one.std <= one.azimuth <= left + one.std:
            seen = f"{right:.4f}…{left:.4f} rad"
            raise ValueError(f"azimuth is {one.azimuth:g} rad, out of the image ({seen}): {_told(one)}")
        for name, value, size in (("column", one.column, lens.width), ("row", one.row, lens.height)):
            if value < -_EDGE or value > size - 1 + _EDGE:
                raise ValueError(f"{name} is {value:g}, out of the image (0…{size - 1}): {_told(one)}")
        if one.beacon is not None and not 0 <= one.beacon < beacons:
            raise ValueError(f"beacon is {one.beacon}, but there are {beacons} of them: {_told(one)}")
    return sorted(found, key=lambda one: one.column)


def _detection(row: Row) -> Detection:
    azimuth, std, column, beacon, height = row
    return Detection(azimuth, std, column, beacon, nan if height is None else height)


def _told(one: Detection) -> str:
    return ", ".join(f"{name} {value}" for name, value in one._asdict().items())
