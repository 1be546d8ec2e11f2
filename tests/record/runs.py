"""Small runs, made up by hand, for the tests of the records."""

from __future__ import annotations

import numpy as np

from hilbed.cost import Cost
from hilbed.record.journal import Journal
from hilbed.record.notes import Notes
from hilbed.record.row import Sink
from hilbed.types import (
    Command,
    Cycle,
    DriveSignals,
    Estimate,
    Frame,
    Innovation,
    Odometry,
    Pose,
    Reading,
    ReferencePoint,
    Snapshot,
    Transfer,
    Truth,
)

PERIOD = 10_000_000
FIELDS = ("speed", "current", "slip", "load_torque", "torque", "speed_ref", "duty")


class Line:
    """A reference along x at 1 m/s."""

    def at(self, t: int) -> ReferencePoint:
        return ReferencePoint(Pose(t * 1e-9, 0.0, 0.0), 1.0, 0.0)


def cycle(k: int, *, innovations: tuple[Innovation, ...] = (), late: int = 0) -> Cycle:
    """Cycle k of a robot that drives along y = 0.1 k at 1 m/s; its counts are `late` ns old.

    Every tenth one has heard of a beacon.
    """
    t = k * PERIOD
    drives = {name: DriveSignals(5.0, 4.9 + k, 0.5 * k) for name in ("left", "right")}
    odometry = Odometry(t - late, 0.01 if k else -late * 1e-9, 0.0, 1.0, 0.0, drives)
    estimate = Estimate(t, np.array([0.01 * k, 0.2, 0.3]), np.diag([1.0, 4.0, 9.0]) + 0.1, innovations)
    readings = [azimuth(t - 30_000_000)] if k % 10 == 0 else []
    truth = Truth(t, Pose(0.01 * k, 0.1 * k, 0.0))
    return Cycle(t, truth, odometry, readings, estimate, Command(0.5, -0.1))


def azimuth(t: int) -> Reading:
    return Reading("azimuth", t, t + 30_000_000, (0.5,), (0.01,))


def ticks(count: int, first: int = 0) -> dict[str, np.ndarray]:
    """The rows first … first + count − 1 of a plant's log: field number + row number / 1000."""
    rows = np.arange(first, first + count)
    log = {"tick/t": rows * 1e-3}
    for drive in ("left", "right"):
        for number, field in enumerate(FIELDS):
            log[f"tick/drive/{drive}/{field}"] = number + rows * 1e-3
    return log


def image(k: int) -> np.ndarray:
    picture = np.zeros((16, 32, 3), np.uint8)
    picture[:, k % 32] = (255, 128, k % 256)
    return picture


def play(sinks: list[Sink], cycles: int = 301, boot: int = 3, close: bool = True) -> Journal:
    """Runs a robot with a camera and two drives through a journal."""
    notes = Notes()
    journal = Journal(notes, sinks, Cost(), Pose(0.0, 0.0, 0.0), Line())
    for k in range(boot):
        notes.transfer(transfer(-1_000_000_000 + k * 1_000_000, 0x700 + k))
    for k in range(cycles):
        t = k * PERIOD
        notes.transfer(transfer(t, 0x80, b""))
        notes.transfer(transfer(t + 50_000, 0x181, k.to_bytes(8, "big")))
        innovations: tuple[Innovation, ...] = ()
        if k % 10 == 0:
            notes.snapshot(Snapshot(t, image(k), 0.1, (3.5, 20.25), (0, None)))
            notes.reading(azimuth(t), 0, (0.49,))
            innovations = (Innovation(t, 1.5, 1, True),)
        journal.record(cycle(k, innovations=innovations, late=5_000_000))
        if k % 100 == 99:
            journal.ticks(ticks(1000, k // 100 * 1000))
    if close:
        journal.close()
    return journal


def transfer(t: int, identifier: int, data: bytes = b"\x01\xab") -> Transfer:
    return Transfer(t, t + 10_000, t + 234_000, Frame(identifier, data), "left")
