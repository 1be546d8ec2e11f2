"""Frames with truth and detections drawn over them: for a page, and as an image file."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from math import degrees, isfinite

import cv2
import numpy as np

from hilbed.report import page
from hilbed.types import Image
from hilbed.vision.lens import Lens
from hilbed.vision.seams import BeaconTruth, Detection
from hilbed.vision_kit.dataset import png
from hilbed.vision_kit.matching import Matched, Sighting
from hilbed.vision_kit.trial import Picture, Rules

SIDE = 48  # pixels of a close-up
GREEN, RED = (0, 160, 60), (225, 30, 50)


def figure(picture: Picture, rules: Rules) -> str:
    """Returns the frame with what is true (green, from above) and what was found (red, from below)."""
    image = picture.labelled.shot.image
    height, width = image.shape[:2]
    marks = "".join(_truth(beacon, height) for beacon in picture.labelled.truth.beacons if beacon.box)
    marks += "".join(_found(one, height) for one in picture.found)
    data = f"data:image/png;base64,{page.base64(png(image))}"
    drawing = f'<image width="{width}" height="{height}" href="{data}"/>{marks}'
    whole = f'<svg role="img" aria-label="frame {picture.frame}" viewBox="0 0 {width} {height}">'
    close = f'<svg role="img" aria-label="close-up" viewBox="{_close_up(picture, rules)}">'
    text = "; ".join(troubles(picture.matched, rules)) or "nothing wrong"
    caption = f"<b>frame {picture.frame}</b> {escape(text)}"
    strip = f'<div class="strip">{whole}{drawing}</svg>{close}{drawing}</svg></div>'
    return f"<figure>{strip}<figcaption>{caption}</figcaption></figure>"


def _close_up(picture: Picture, rules: Rules) -> str:
    """Returns the part of a frame that holds the worst of it, as a view box: left, top, width, height."""
    shot, beacons = picture.labelled.shot, picture.labelled.truth.beacons
    height, width = shot.image.shape[:2]
    side = min(SIDE, height)
    matched = picture.matched
    column, row = 0.5 * width, 0.5 * height
    if matched.strays and not any(one.mistaken for one in matched.sightings):
        column = picture.found[matched.strays[0].detection].column
    elif matched.sightings:
        worst = beacons[max(matched.sightings, key=lambda one: _trouble(one, rules)).beacon]
        column, row = worst.column, worst.row
    left = min(max(column - side / 2, 0), width - side) if isfinite(column) else 0
    top = min(max(row - side / 2, 0), height - side) if isfinite(row) else 0
    return f"{left:.1f} {top:.1f} {side} {side}"


def _trouble(one: Sighting, rules: Rules) -> tuple[bool, bool, float]:
    return one.mistaken, rules.due(one) and not one.found, abs(one.error_px) if one.found else 0.0


def _truth(beacon: BeaconTruth, height: int) -> str:
    if not isfinite(beacon.column):
        return ""
    x = beacon.column + 0.5
    return (
        f'<line class="true" x1="{x:.2f}" x2="{x:.2f}" y1="0" y2="{0.5 * height:.1f}"/>'
        f'<text class="true" x="{x + 3:.1f}" y="11">{beacon.beacon}</text>'
    )


def _found(one: Detection, height: int) -> str:
    x = one.column + 0.5
    name = "?" if one.beacon is None else str(one.beacon)
    return (
        f'<line class="found" x1="{x:.2f}" x2="{x:.2f}" y1="{0.5 * height:.1f}" y2="{height}"/>'
        f'<text class="found" x="{x + 3:.1f}" y="{height - 3}">{name}</text>'
    )


def troubles(matched: Matched, rules: Rules) -> list[str]:
    """Returns what is wrong with a frame in words, the worst first."""
    ones = matched.sightings
    told = [f"beacon {one.beacon} taken for {one.named}" for one in ones if one.mistaken]
    if matched.strays:
        told.append(f"{len(matched.strays)} detection{'s' * (len(matched.strays) > 1)} of nothing")
    told += [f"beacon {one.beacon} missed{_at(one)}" for one in ones if rules.due(one) and not one.found]
    worst = max((one for one in ones if one.found), key=lambda one: abs(one.error_px), default=None)
    if worst is not None:
        size = f"{1000 * degrees(worst.error):+.3g} mdeg ({worst.error_px:+.2g} px)"
        told.append(f"largest error {size} at beacon {worst.beacon}{_at(worst)}")
    return told


def _at(one: Sighting) -> str:
    part = "" if one.visible > 0.995 else f", {100 * one.visible:.0f} % visible"
    return f" ({one.distance:.1f} m{part})"


def drawn(image: Image, lens: Lens, beacons: Sequence[BeaconTruth], found: Sequence[Detection]) -> Image:
    """Returns an image four times as large, with what is true (green) and what was found (red)."""
    scale = 4 if lens.width <= 1024 else 1
    large = np.asarray(cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_NEAREST), np.uint8)
    height = large.shape[0]
    for beacon in beacons:
        if beacon.box is not None and isfinite(beacon.column):
            _mark(large, scale * (beacon.column + 0.5), (0, height // 2), GREEN, str(beacon.beacon))
    for one in found:
        name = "?" if one.beacon is None else str(one.beacon)
        _mark(large, scale * (one.column + 0.5), (height // 2, height), RED, name)
    return large


def _mark(image: Image, x: float, rows: tuple[int, int], colour: tuple[int, int, int], text: str) -> None:
    column = round(x)
    cv2.line(image, (column, rows[0]), (column, rows[1] - 1), colour, 1)
    place = (column + 3, 16 if rows[0] == 0 else rows[1] - 6)
    cv2.putText(image, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.5, colour, 1, cv2.LINE_AA)
