"""`hilbed fit RUN`: noise, delay and offset that explain a run with truth, as lines for a scenario."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from math import log, sqrt
from pathlib import Path
from typing import Any, NamedTuple
from zipfile import BadZipFile

import numpy as np

from hilbed.clock import nanos
from hilbed.estimation.calibration import (
    SensorFit,
    Sightings,
    fit_odometry,
    fit_sensor,
    increments,
    track,
    witnessed,
)
from hilbed.estimation.consistency import nees, pose_error
from hilbed.estimation.odometry_model import OdometryModel
from hilbed.estimation.specs import EkfSpec, OdometrySpec, ReadingSpec
from hilbed.types import Odometry, Pose, Reading, ScenarioError

Point = tuple[float, float]
Signals = Mapping[str, Any]

WINDOW = 2.0  # s: over it odometry is compared with truth
SHORTEST = 5.0  # s: in less there is nothing to be learnt
RATIOS = tuple(
    2 ** (k / 2) for k in range(-2, 5)
)  # of readings' doubt to odometry's, over that of white noise


def fit(run: Path, fraction: float = 0.5) -> str:
    """Returns an `estimator:` block fitted on the first part of a run folder.

    fraction: of the run's rows, in (0, 1]. Raises ScenarioError where the folder holds no run, no truth
    or no readings.
    """
    if not 0 < fraction <= 1:
        raise ScenarioError(f"fit: the fraction of the run must lie in (0, 1], given {fraction:g}")
    whole = _signals(run)
    if "beacons" not in whole:
        raise ScenarioError(f"fit: {run} is a run without beacons, there are no readings to fit")
    try:
        beacons: list[Point] = [(x, y) for x, y in whole["beacons"].tolist()]
        signals = first_part(whole, fraction)
        found = fit_signals(signals, beacons)
    except (LookupError, TypeError, ValueError, ArithmeticError) as error:
        raise ScenarioError(f"fit: {run} holds a run that cannot be fitted to: {error!r}") from error
    told = ", ".join(f"{count} {kind} readings" for kind, (*_, count) in found.sensor.kinds.items())
    return "\n".join(
        (
            f"# fitted on {signals['t'][0]:g} … {signals['t'][-1]:g} s of {run}: {told};",
            f"# white noise of readings times {found.readings:.3g}, of odometry times {found.odometry:.3g}",
            *lines(found.spec),
            "",
        )
    )


def _signals(run: Path) -> dict[str, Any]:
    try:
        with np.load(run / "signals.npz", allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (OSError, ValueError, EOFError, BadZipFile) as error:
        raise ScenarioError(f"fit: {run} holds no readable signals.npz ({error})") from None


def first_part(signals: Signals, fraction: float) -> dict[str, Any]:
    """Returns the rows of the first part of a run, and the readings delivered in it."""
    rows = max(int(len(signals["t"]) * fraction), 2)
    end = signals["t"][:rows][-1]
    part = {name: signals[name][:rows] for name in ("t", "truth", "odometry")}
    for kind in ("azimuth", "range"):
        if f"{kind}/t" in signals:
            keep = signals[f"{kind}/delivered"] <= end
            part |= {
                f"{kind}/{c}": signals[f"{kind}/{c}"][keep] for c in ("t", "delivered", "beacon", "measured")
            }
    return part


class Fitted(NamedTuple):
    """The filter, what was found of the sensor, and the factors on the noise of readings and odometry."""

    spec: EkfSpec
    sensor: SensorFit
    readings: float
    odometry: float


def fit_signals(signals: Signals, beacons: Sequence[Point]) -> Fitted:
    """Returns the filter under which a run's true poses are likeliest.

    Delay, mount, biases and scales are least squares. Noise is more: errors of real sensors last, so that
    many readings are worth few, and a filter that takes them for white is far too sure. So the ratio of
    readings' to odometry's noise is searched, and both are scaled, for the least NEES + log det P of the
    filter. Scaling all noise by f leaves its means and makes P f² P, so f² = mean NEES / 3 is the best.
    """
    t, truth = signals["t"], signals["truth"]
    sensor = fit_sensor(track(t, truth), _sightings(signals, beacons))
    rows = max(round(WINDOW / float(np.median(np.diff(t)))), 1)
    odometry = fit_odometry(truth, signals["odometry"], rows)
    trials = []
    for ratio in RATIOS:
        mean_nees, log_det = trial(_spec(sensor, odometry, (ratio, 1.0)), signals, beacons)
        trials.append((3 * log(mean_nees / 3) + log_det, ratio, sqrt(mean_nees / 3)))
    _, ratio, scale = min(trials)
    factors = ratio * scale, scale
    return Fitted(_spec(sensor, odometry, factors), sensor, *factors)


def _sightings(signals: Signals, beacons: Sequence[Point]) -> dict[str, Sightings]:
    if signals["t"][-1] - signals["t"][0] < SHORTEST:
        raise ScenarioError(f"fit: less than {SHORTEST:g} s of the run are left to fit to")
    places = np.array(beacons, dtype=float).reshape(-1, 2)
    if not np.isfinite(signals["truth"]).all(axis=1).any():
        raise ScenarioError("fit: the run has no truth to fit to")
    found = {}
    for kind in ("azimuth", "range"):
        if f"{kind}/t" in signals:
            real = signals[f"{kind}/beacon"] >= 0
            beacon = places[signals[f"{kind}/beacon"][real]]
            seen = Sightings(signals[f"{kind}/t"][real], beacon, signals[f"{kind}/measured"][real])
            seen = witnessed(seen, signals["t"], signals["truth"])
            if len(seen.t) >= 20:
                found[kind] = seen
    if not found:
        raise ScenarioError("fit: fewer than 20 azimuths or ranges were taken where the truth is known")
    return found


def _spec(sensor: SensorFit, odometry: OdometryModel, factors: tuple[float, float]) -> EkfSpec:
    """Returns the filter with the noise of readings and of odometry taken times their factors."""
    noisier = {name: getattr(odometry, name) * factors[1] for name in odometry._fields if "noise" in name}
    model = {name: _short(value) for name, value in odometry._replace(**noisier)._asdict().items()}
    kinds = {kind: _reading(sensor, kind, factors[0]) for kind in sensor.kinds}
    return EkfSpec(
        delay=_short(sensor.delay),
        mount=(_short(sensor.mount[0]), _short(sensor.mount[1])),
        odometry=OdometrySpec(**model),
        azimuth=kinds.get("azimuth", ReadingSpec()),
        range=kinds.get("range", ReadingSpec()),
    )


def _reading(sensor: SensorFit, kind: str, factor: float) -> ReadingSpec:
    bias, std, beacon_std, _ = sensor.kinds[kind]
    return ReadingSpec(std=_short(factor * std), bias=_short(bias), beacon_std=_short(factor * beacon_std))


def _short(value: float) -> float:
    """Returns three digits, none below a micrometre or a microradian."""
    return round(float(f"{value:.3g}"), 6) + 0.0  # no −0.0


def trial(spec: EkfSpec, signals: Signals, beacons: Sequence[Point]) -> tuple[float, float]:
    """Returns mean NEES and mean log det P of a filter, without its gate, over a run's rows."""
    from hilbed.estimation.ekf import Ekf

    truth = signals["truth"]
    start = int(np.flatnonzero(np.isfinite(truth).all(axis=1))[0])
    readings = deque(_deliveries(signals))
    ekf = Ekf(spec.model_copy(update={"gate": None}), beacons, Pose(*truth[start].tolist()))
    origin, estimates = nanos(float(signals["t"][start])), []
    for odometry in _increments(signals, start):
        due = []
        while readings and readings[0].delivered <= origin + odometry.t:
            due.append(_moved(readings.popleft(), origin))
        estimates.append(ekf.step(odometry.t, odometry, due))
    error = pose_error(np.array([e.mean for e in estimates]), truth[start:])
    covariance = np.array([e.covariance for e in estimates])
    return float(np.nanmean(nees(error, covariance))), float(np.linalg.slogdet(covariance)[1].mean())


def _increments(signals: Signals, start: int) -> list[Odometry]:
    """Returns dead-reckoned poses as odometry, with time from row `start`."""
    t = signals["t"][start:] - signals["t"][start]
    told = increments(signals["odometry"][start:])
    rates = told[:, ::2] / np.diff(t)[:, None]
    rows = [Odometry(0, 0.0, 0.0, 0.0, 0.0)]
    for end, (way, _, turn), (v, w) in zip(t[1:].tolist(), told.tolist(), rates.tolist(), strict=True):
        rows.append(Odometry(nanos(end), way, turn, v, w))
    return rows


def _deliveries(signals: Signals) -> list[Reading]:
    readings = [
        Reading(kind, nanos(t), nanos(delivered), (value,), (1.0,), beacon)
        for kind in ("azimuth", "range")
        if f"{kind}/t" in signals
        for t, delivered, beacon, value in zip(
            *(signals[f"{kind}/{c}"].tolist() for c in ("t", "delivered", "beacon", "measured")), strict=True
        )
        if beacon >= 0
    ]
    return sorted(readings, key=lambda reading: reading.delivered)


def _moved(reading: Reading, origin: int) -> Reading:
    return reading._replace(t=reading.t - origin, delivered=reading.delivered - origin)


def lines(spec: EkfSpec) -> list[str]:
    """Returns the filter's block of a scenario, YAML, only what was fitted."""
    told = spec.model_dump(exclude_unset=True)
    block = ["estimator:", "  kind: ekf"]
    for key, value in told.items():
        if isinstance(value, dict):
            inside = [f"{k}: {v!r}" for k, v in value.items()]
            block += [f"  {key}: {{{', '.join(inside)}}}"] if inside else []
        elif isinstance(value, tuple):
            block.append(f"  {key}: [{', '.join(map(repr, value))}]")
        else:
            block.append(f"  {key}: {value!r}")
    return block
