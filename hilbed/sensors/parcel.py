"""Requests and findings on the line to a camera's own process, as plain tuples.

Pickled as they stand, named tuples would take ten times as long; the bench waits for both ends of the line.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

from hilbed.sensors.exposure import Exposure, Moment
from hilbed.sensors.eye import Finding
from hilbed.types import Pose
from hilbed.vision.seams import Detection

Plain: TypeAlias = tuple[Any, ...]


def plain_exposure(exposure: Exposure) -> Plain:
    """Returns an exposure as `made_exposure` takes it."""
    return exposure.t, [(t, *pose, pan) for t, pose, pan in exposure.moments]


def made_exposure(plain: Plain) -> Exposure:
    """Returns the exposure that was made plain."""
    t, moments = plain
    return Exposure(t, tuple(Moment(then, Pose(x, y, yaw), pan) for then, x, y, yaw, pan in moments))


def plain_findings(findings: Sequence[Finding]) -> list[Plain]:
    """Returns findings as `made_findings` takes them."""
    return [(detection[:], beacon, azimuth) for detection, beacon, azimuth in findings]


def made_findings(plain: Sequence[Plain]) -> list[Finding]:
    """Returns the findings that were made plain."""
    return [Finding(Detection(*detection), beacon, azimuth) for detection, beacon, azimuth in plain]
