"""Cycles in the MCAP log: kept as numbers for a second, then packed all at once (3 µs a message saved)."""

from __future__ import annotations

from array import array
from collections.abc import Sequence

import numpy as np

from hilbed.record import messages
from hilbed.record.channels import Channels, log_packed
from hilbed.record.row import Row
from hilbed.types import Array, Nanos

POSES = ("truth", "estimate", "odometry", "reference")
_POSE = ("x", "y", "yaw")
_WIDTH = 23  # numbers a cycle: three poses, command, estimate, covariance
_DRIVE = ("speed_ref", "speed_measured", "current_measured")
_CYCLE = {**dict.fromkeys((*POSES, "error", "sigma"), _POSE), "command": ("v", "w"), "": ("covariance[9]",)}


class CycleLog:
    """Topics /cycle, /pose/…, /tf and /drives, one message a cycle each; log time is t + `offset` (ns)."""

    def __init__(self, channels: Channels, offset: Nanos) -> None:
        self._channels = channels
        self._offset = offset
        self._cycle = channels.rows("/cycle", "Cycle", _CYCLE)
        self._pose = {name: channels.ros(f"/pose/{name}", messages.POSE) for name in POSES}
        self._transform = channels.ros("/tf", messages.TRANSFORM)
        self._drives: tuple[str, ...] = ()
        self._stamps: list[Nanos] = []
        self._numbers = array("d")
        self._drive_numbers = array("d")

    def note(self, row: Row) -> None:
        """Keeps a cycle until the next `flush`."""
        (t, truth, wheels, _, estimate, command), odometry, reference = row
        self._stamps.append(t + self._offset)
        extend = self._numbers.extend
        extend((*truth.pose, *odometry, *reference, *command))
        extend(estimate.mean.tolist()[:3])
        for line in estimate.covariance.tolist()[:3]:
            extend(line[:3])
        if wheels.drives:
            self._drives = self._drives or tuple(wheels.drives)
            for name in self._drives:
                self._drive_numbers.extend(wheels.drives[name])

    def flush(self) -> None:
        """Logs the cycles kept so far."""
        if not self._stamps:
            return
        stamps = np.array(self._stamps)
        rows = np.array(self._numbers).reshape(len(stamps), _WIDTH)
        self._log_cycles(stamps, rows)
        if self._drives and len(self._drive_numbers):
            log = self._channels.rows("/drives", "Drives", dict.fromkeys(self._drives, _DRIVE))
            log(stamps, np.array(self._drive_numbers).reshape(len(stamps), -1))
        self._stamps.clear()
        del self._numbers[:], self._drive_numbers[:]

    def _log_cycles(self, stamps: np.ndarray, rows: Array) -> None:
        truth, odometry, reference = rows[:, 0:3], rows[:, 3:6], rows[:, 6:9]
        command, estimate, covariance = rows[:, 9:11], rows[:, 11:14], rows[:, 14:23]
        error = estimate - truth
        error[:, 2] -= 2 * np.pi * np.rint(error[:, 2] / (2 * np.pi))
        sigma = np.sqrt(np.maximum(covariance[:, ::4], 0.0))
        poses = (truth, estimate, odometry, reference)
        self._cycle(stamps, np.hstack([*poses, error, sigma, command, covariance]))
        self._log_poses(stamps, poses)

    def _log_poses(self, stamps: np.ndarray, poses: Sequence[Array]) -> None:
        for name, pose in zip(POSES, poses, strict=True):
            known = np.isfinite(pose).all(axis=1)
            log_packed(self._pose[name], stamps[known], messages.pose_messages(stamps[known], pose[known]))
        log_packed(self._transform, stamps, messages.transform_messages(stamps, poses[1]))
