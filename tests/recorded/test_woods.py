"""630 s of a real robot: fitted on the first half, judged on the second."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from hilbed.estimation.consistency import nees, pose_error
from hilbed.estimation.ekf import Ekf
from hilbed.estimation.specs import EkfSpec
from hilbed.fit import first_part, fit_signals
from hilbed.plant.recorded import Recorded
from hilbed.plant.recorded_spec import RecordedSpec
from hilbed.plant.recording import load
from hilbed.plant.replay import RecordedBase, RecordedPlant, RecordedSensor
from hilbed.poses import moved
from hilbed.types import Array
from tests.recorded.test_replay import Notes

PERIOD = 100_000_000
FILE = Path(os.environ.get("HILBED_DATA", "")) / "woods.npz"

pytestmark = pytest.mark.skipif(
    not (os.environ.get("HILBED_DATA") and FILE.is_file()),
    reason="HILBED_DATA names no folder with woods.npz",
)


class Run(NamedTuple):
    error: Array
    nees: Array
    odometry_error: Array
    signals: dict[str, Any]


def play(spec: EkfSpec, **recorded: Any) -> Run:
    part = Recorded(RecordedSpec(kind="recorded", file="woods.npz", max_range=3.0, **recorded), load(FILE))
    notes, base, plant = Notes(), RecordedBase(part), RecordedPlant(part)
    kinds = ["azimuth", "range"] if recorded.get("range") else ["azimuth"]
    sensors = [RecordedSensor(part, kind, notes) for kind in kinds]
    ekf = Ekf(spec, part.beacons, part.start, part.mount)
    pose, rows = part.start, []
    for t in part.times:
        odometry = base.read(t)
        pose = moved(pose, odometry.distance, odometry.turn)
        estimate = ekf.step(t, odometry, [r for sensor in sensors for r in sensor.read(t)])
        rows.append((plant.truth().pose, pose, estimate.mean, estimate.covariance))
        plant.advance(t, t + PERIOD)
    truth, reckoned, mean, covariance = (np.array(column) for column in zip(*rows, strict=True))
    error = pose_error(mean, truth)
    signals = {"t": np.array(part.times) * 1e-9, "truth": truth, "odometry": reckoned}
    for kind in kinds:
        seen = [
            (r.t * 1e-9, r.delivered * 1e-9, b, r.value[0]) for r, b, _ in notes.readings if r.kind == kind
        ]
        t, delivered, beacon, measured = np.array(seen).T
        columns = {"t": t, "delivered": delivered, "beacon": beacon.astype(int), "measured": measured}
        signals |= {f"{kind}/{name}": column for name, column in columns.items()}
    return Run(error, nees(error, covariance), pose_error(reckoned, truth), signals)


def rms(error: Array) -> tuple[float, float]:
    known = error[np.isfinite(error).all(axis=1)]
    return float(np.sqrt(np.mean(np.sum(known[:, :2] ** 2, axis=1)))), float(
        np.sqrt(np.mean(known[:, 2] ** 2))
    )


@pytest.mark.parametrize(
    ("part", "metres", "radians"),
    [({}, 0.04, 0.015), ({"range": True, "length": 300.0}, 0.025, 0.013)],
)
def test_what_the_first_half_teaches_holds_in_the_second(
    part: dict[str, Any], metres: float, radians: float
) -> None:
    plain = play(EkfSpec(gate=None), **part)
    half = len(plain.error) // 2
    spec = fit_signals(first_part(plain.signals, 0.5), load(FILE).landmarks.tolist()).spec
    better = play(spec, **part)
    position, yaw = rms(better.error[half:])
    assert position < metres
    assert yaw < radians
    assert 0.5 < np.nanmean(better.nees[half:]) < 5
    assert rms(plain.error[half:])[0] > 3 * position, "the plain filter"
    assert rms(better.odometry_error[half:])[0] > 30 * position, "dead reckoning"


def test_nobody_s_azimuths_are_as_good() -> None:
    """Association by the filter alone, with what was fitted for the named ones."""
    named = play(EkfSpec(gate=None), start=0.0, length=160.0)
    spec = fit_signals(named.signals, load(FILE).landmarks.tolist()).spec
    position, yaw = rms(play(spec, start=160.0, length=155.0, anonymous=True).error)
    assert position < 0.05
    assert yaw < 0.02
