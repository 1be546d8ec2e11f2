"""Cycles in the MCAP log."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import numpy as np

from hilbed.record import messages
from hilbed.record.channels import Channels, log_packed
from hilbed.record.row import Row
from hilbed.types import Array, DriveSignals, Nanos

POSES = ("truth", "estimate", "odometry", "reference")
_POSE = ("x", "y", "yaw")
_DRIVE = DriveSignals._fields
_THINNED = 5  # every fifth pose is enough to look at: /cycle has them all
_CYCLE = {**dict.fromkeys((*POSES, "error", "sigma"), _POSE), "command": ("v", "w"), "": ("covariance[9]",)}


class CycleLog:
    """Topics /cycle, /tf and /drives, a message a cycle each, and /pose/…; log time is t + `offset` (ns)."""

    def __init__(self, channels: Channels, offset: Nanos) -> None:
        self._channels = channels
        self._offset = offset
        self._cycle = channels.rows("/cycle", "Cycle", _CYCLE)
        self._pose = {name: channels.ros(f"/pose/{name}", messages.POSE) for name in POSES}
        self._transform = channels.ros("/tf", messages.TRANSFORM)

    def log(self, rows: Sequence[Row]) -> None:
        """Logs cycles, packed all at once."""
        if not rows:
            return
        stamps = np.array([row.t for row in rows]) + self._offset
        self._log_cycles(stamps, np.array([row.numbers for row in rows]))
        drives = {name: _fields(one) for name, one in rows[0].drives.items()}
        if drives:
            log = self._channels.rows("/drives", "Drives", drives)
            widths = [(name, len(fields)) for name, fields in drives.items()]
            log(stamps, np.array([_signals(row, widths) for row in rows]))

    def _log_cycles(self, stamps: np.ndarray, rows: Array) -> None:
        truth, odometry, reference = rows[:, 0:3], rows[:, 3:6], rows[:, 6:9]
        command, estimate, covariance = rows[:, 9:11], rows[:, 11:14], rows[:, 14:23]
        error = estimate - truth
        error[:, 2] -= 2 * np.pi * np.rint(error[:, 2] / (2 * np.pi))
        sigma = np.sqrt(np.maximum(covariance[:, ::4], 0.0))
        poses = (truth, estimate, odometry, reference)
        self._cycle(stamps, np.hstack([*poses, error, sigma, command, covariance]))
        self._log_poses(stamps, poses)
        log_packed(self._transform, stamps, messages.transform_messages(stamps, estimate))

    def _log_poses(self, stamps: np.ndarray, poses: Sequence[Array]) -> None:
        for name, pose in zip(POSES, poses, strict=True):
            known = np.flatnonzero(np.isfinite(pose).all(axis=1))[::_THINNED]
            log_packed(self._pose[name], stamps[known], messages.pose_messages(stamps[known], pose[known]))


def _fields(drive: DriveSignals) -> tuple[str, ...]:
    """Returns what a drive has: only a steering axis has an angle."""
    return _DRIVE if isfinite(drive.angle_ref) else _DRIVE[:3]


def _signals(row: Row, widths: Sequence[tuple[str, int]]) -> list[float]:
    return [number for name, width in widths for number in row.drives[name][:width]]
