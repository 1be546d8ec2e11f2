"""Signals of a run as columns: collected row by row, handed over as arrays (the contract of signals.npz)."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Mapping
from math import nan
from typing import NamedTuple

import numpy as np

from hilbed.clock import MILLISECOND
from hilbed.record.clouds import Clouds
from hilbed.record.rounds import first_rounds
from hilbed.record.row import WIDTH, Batch, Row, Witnessed
from hilbed.types import Array, DriveSignals, Innovation, Nanos, Reading, Transfer

MEASURED = DriveSignals._fields
OF_STEERING = ("angle_ref", "angle_measured")
_UNKNOWN = (nan,) * len(MEASURED)
_NS = 1e-9


class Readings(NamedTuple):
    """Growing columns of one kind of reading; measured, true and std hold `size` numbers a reading.

    beacons: the true one, then the one that the sensor took it for.
    """

    size: int
    stamps: array[float]
    beacons: array[int]
    values: array[float]


class Columns:
    """A sink that keeps all signals in memory, about 400 bytes a cycle, and turns them into arrays.

    drives: names, in the robot's order; kinds: what the sensors measure, each with its number of
    components, {"azimuth": 1, "position": 2}, so that a kind that was never read still has its columns.
    """

    def __init__(self, drives: Iterable[str] = (), kinds: Mapping[str, int] | None = None) -> None:
        self._rows = array("d")
        self._drives = tuple(drives)
        self._drive_rows = array("d")
        self._readings = {kind: _empty(size) for kind, size in (kinds or {}).items()}
        self._waiting: list[Witnessed] = []
        self._innovations = array("d")
        self._bus = array("q")
        self._clouds = Clouds()

    def take(self, batch: Batch) -> None:
        if batch.transfers:
            self._note_transfers(batch.transfers)
        self._waiting += batch.readings
        for row in batch.rows:
            self._note_row(row)

    def close(self) -> None:
        """Has nothing to close."""

    def _note_row(self, row: Row) -> None:
        t, numbers, drives, innovations, cloud = row
        self._rows.append(t * _NS)
        self._rows.extend(numbers)
        for drive in self._drives:
            self._drive_rows.extend(drives.get(drive, _UNKNOWN))
        for innovation in innovations:
            self._note_innovation(innovation)
        self._clouds.note(t, cloud)

    def _note_innovation(self, innovation: Innovation) -> None:
        t, nis, dof, accepted = innovation
        self._innovations.extend((t * _NS, nis, dof, accepted))

    def _note_transfers(self, transfers: Iterable[Transfer]) -> None:
        extend = self._bus.extend
        for queued, start, end, frame, _, error in transfers:
            extend((queued, start, end, frame.id, error))

    def finish(
        self, ticks: Mapping[str, Array] | None = None, tick: Nanos = MILLISECOND
    ) -> dict[str, np.ndarray]:
        """Returns every signal by its name in signals.npz; of an aborted run, what there was of it.

        ticks: the plant's log, "tick/t" (M,) and "tick/drive/NAME/…" (M,), row k at time k·`tick` (ns).
        A reading that was not delivered by the last row makes no row.
        """
        signals = _poses(np.array(self._rows).reshape(-1, 1 + WIDTH))
        t = signals["t"]
        signals |= self._measured(len(t)) | self._clouds.columns()
        signals |= _plant(t, ticks or {}, tick * _NS)
        signals |= self._read(t[-1] if len(t) else -np.inf)
        if self._innovations or self._readings:
            signals |= _table("nis", ("t", "value", "dof", "accepted"), self._innovations)
            signals["nis/dof"] = signals["nis/dof"].astype(np.int64)
            signals["nis/accepted"] = signals["nis/accepted"].astype(np.bool_)
        if self._bus:
            signals |= _frames(np.array(self._bus, dtype=np.int64).reshape(-1, 5))
        return signals

    def _measured(self, count: int) -> dict[str, Array]:
        rows = np.array(self._drive_rows).reshape(count, len(self._drives), len(MEASURED))
        signals = {}
        for k, drive in enumerate(self._drives):
            for column, name in enumerate(MEASURED):
                if not (name in OF_STEERING and np.isnan(rows[:, k, column]).all()):
                    signals[f"drive/{drive}/{name}"] = rows[:, k, column].copy()
        return signals

    def _read(self, last: float) -> dict[str, np.ndarray]:
        for witnessed in sorted(self._waiting, key=_delivery):
            reading = witnessed.reading
            if reading.delivered * _NS <= last:
                kind = self._readings.setdefault(reading.kind, _empty(len(reading.value)))
                kind.stamps.extend((reading.t * _NS, reading.delivered * _NS))
                kind.beacons.extend((witnessed.beacon, -1 if reading.beacon is None else reading.beacon))
                for numbers in (reading.value, witnessed.true, reading.std):
                    kind.values.extend(_padded(numbers, kind.size))
        self._waiting.clear()
        return {
            name: column
            for kind, readings in self._readings.items()
            for name, column in _columns_of(kind, readings).items()
        }


def _empty(size: int) -> Readings:
    return Readings(size, array("d"), array("q"), array("d"))


def _delivery(witnessed: Witnessed) -> tuple[Nanos, Nanos]:
    reading: Reading = witnessed.reading
    return reading.delivered, reading.t


def _padded(value: tuple[float, ...], size: int) -> tuple[float, ...]:
    """Returns `size` numbers: a spurious reading's truth may be told as a single NaN."""
    return (*value, *[nan] * size)[:size]


def _poses(rows: Array) -> dict[str, np.ndarray]:
    columns = {
        "t": rows[:, 0],
        "truth": rows[:, 1:4],
        "odometry": rows[:, 4:7],
        "reference": rows[:, 7:10],
        "command": rows[:, 10:12],
        "estimate": rows[:, 12:15],
        "covariance": rows[:, 15:24].reshape(-1, 3, 3),
        "odometry_step": rows[:, 25:30],
    }
    if not np.isnan(rows[:, 24]).all():
        columns["landmark_distance"] = rows[:, 24]
    return {name: np.ascontiguousarray(column) for name, column in columns.items()}


def _plant(t: Array, ticks: Mapping[str, Array], tick: float) -> dict[str, np.ndarray]:
    """Returns the tick log and, from it, the drives' rows at the cycles; NaN where the log ends early."""
    signals: dict[str, np.ndarray] = {name: np.array(column, dtype=float) for name, column in ticks.items()}
    index = np.rint(t / tick).astype(np.int64)
    for name, column in ticks.items():
        if name.startswith("tick/drive/") and len(column):
            known = np.clip(index, 0, len(column) - 1)
            signals[name.removeprefix("tick/")] = np.where(index < len(column), column[known], nan)
    return signals


def _frames(rows: np.ndarray) -> dict[str, np.ndarray]:
    """Returns the columns of the bus from rows (n, 5) of queued, start, end (ns), identifier, error."""
    queued, start, end, identifier, error = rows.T
    return {
        "bus/t": end * _NS,
        "bus/latency": (end - queued) * _NS,
        "bus/duration": (end - start) * _NS,
        "bus/arbitration": (start - first_rounds(queued, start)) * _NS,
        "bus/id": identifier.copy(),
        "bus/error": error.copy(),
    }


def _columns_of(kind: str, readings: Readings) -> dict[str, np.ndarray]:
    stamps = np.array(readings.stamps).reshape(-1, 2)
    beacons = np.array(readings.beacons, dtype=np.int64).reshape(-1, 2)
    values = np.array(readings.values).reshape(-1, 3, readings.size)
    if readings.size == 1:
        values = values[:, :, 0]
    return {
        f"{kind}/t": stamps[:, 0].copy(),
        f"{kind}/delivered": stamps[:, 1].copy(),
        f"{kind}/beacon": beacons[:, 0].copy(),
        f"{kind}/measured": values[:, 0].copy(),
        f"{kind}/true": values[:, 1].copy(),
        f"{kind}/std": values[:, 2].copy(),
        f"{kind}/claimed": beacons[:, 1].copy(),
    }


def _table(prefix: str, names: tuple[str, ...], numbers: array[float]) -> dict[str, np.ndarray]:
    rows = np.array(numbers).reshape(-1, len(names))
    return {f"{prefix}/{name}": rows[:, column].copy() for column, name in enumerate(names)}
