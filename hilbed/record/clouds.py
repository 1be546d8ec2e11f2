"""Particle clouds of a run, kept at a few cycles: early on often, later ever more rarely."""

from __future__ import annotations

import numpy as np

from hilbed.types import Array, Nanos

MOST = 1000  # particles a cloud in the record


class Clouds:
    """Keeps the cloud at cycles 0, 1, 2, 3, 5, 10, 20, 30, 50, 100 … and at the last one.

    What is kept depends on the run alone, not on its recorders: it is part of the hash.
    """

    def __init__(self) -> None:
        self._cycles = 0
        self._kept: dict[Nanos, Array] = {}
        self._last: tuple[Nanos, Array] | None = None

    def note(self, t: Nanos, cloud: Array | None) -> None:
        """Takes the cloud (M, 3) of the next cycle, None where the estimate has none."""
        if cloud is not None:
            self._last = t, cloud
            if kept(self._cycles):
                self._kept[t] = cloud
        self._cycles += 1

    def columns(self) -> dict[str, np.ndarray]:
        """Returns "cloud/t" (K,) s and "cloud/particles" (K, M, 3): x, y (m), yaw (rad); nothing without any.

        Of more than 1000 particles every second, third … is kept.
        """
        if self._last is None:
            return {}
        clouds = self._kept | dict([self._last])
        particles = np.stack([cloud[:: 1 + (len(cloud) - 1) // MOST] for cloud in clouds.values()])
        return {"cloud/t": np.array(list(clouds)) * 1e-9, "cloud/particles": particles}


def kept(cycle: int) -> bool:
    """Tells whether the cloud of a cycle is kept: 0 and those of the series 1, 2, 3, 5, 10, 20 …"""
    return str(cycle).strip("0") in ("", "1", "2", "3", "5")
