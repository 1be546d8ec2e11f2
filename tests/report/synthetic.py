"""A run that never happened, with signals that look like one: for the report and for a look at it.

`python -m tests.report.synthetic FOLDER` writes a run folder with its report.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import yaml

from hilbed.cost import Cost
from hilbed.criteria import CriterionSpec
from hilbed.record.candump import CandumpLog
from hilbed.record.folder import RunFolder
from hilbed.record.frames import Frames
from hilbed.record.journal import Journal
from hilbed.record.notes import Notes
from hilbed.record.row import Sink
from hilbed.types import Frame, Pose, Snapshot, Transfer
from hilbed.verdict import Account, conclude, text

BEACONS = [((-1.5, -2.0), "red"), ((4.5, -2.0), "green"), ((4.5, 4.0), "blue"), ((-1.5, 4.0), "magenta")]
PERIOD, TICK, SPEED, TRACK, RADIUS = 0.01, 0.001, 0.5, 0.4, 0.1
LOAD, PATCH, LOSS = (10.0, 5.0), (22.0, 4.0), (30.0, 3.0)

Columns = dict[str, np.ndarray]


def stadium(s: np.ndarray, straight: float = 3.0, radius: float = 1.0) -> np.ndarray:
    """Poses (n, 3) at path lengths s (n,) along a stadium that starts at the origin along x."""
    arc = np.pi * radius
    s = np.mod(s, 2 * (straight + arc))
    turn = np.clip((s - straight) / radius, 0, np.pi) + np.clip((s - 2 * straight - arc) / radius, 0, np.pi)
    there, back = np.clip(s, 0, straight), np.clip(s - straight - arc, 0, straight)
    x = there - back + radius * np.sin(turn)
    y = radius * (1 - np.cos(turn))
    return np.column_stack([x, y, turn])


def within(t: np.ndarray, span: tuple[float, float]) -> np.ndarray:
    return (t >= span[0]) & (t < span[0] + span[1])


def wander(rng: np.random.Generator, count: int, size: float, memory: float) -> np.ndarray:
    """Coloured noise (count,) of a standard deviation and a memory in rows."""
    a = np.exp(-1 / memory)
    noise = rng.normal(size=count) * size * np.sqrt(1 - a * a)
    out = np.zeros(count)
    for k in range(1, count):
        out[k] = a * out[k - 1] + noise[k]
    return out


def signals(duration: float = 60.0, seed: int = 1) -> Columns:
    """All signals of a tracking run on the full bench."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(duration / PERIOD) + 1) * PERIOD
    run: Columns = {"t": t, "reference": stadium(SPEED * t)}
    n = len(t)
    run["truth"] = run["reference"] + np.column_stack([wander(rng, n, s, 300) for s in (0.012, 0.012, 0.015)])
    sigma = np.column_stack([0.012 + 0.03 * _sawtooth(t)] * 2 + [0.01 + 0.02 * _sawtooth(t)])
    run["estimate"] = run["truth"] + sigma * np.column_stack([wander(rng, n, 0.8, 40) for _ in range(3)])
    run["covariance"] = sigma[:, :, None] * np.eye(3)
    run["covariance"] = run["covariance"] * sigma[:, None, :]
    drift = np.cumsum(wander(rng, n, 0.0015, 400) + 0.0004 * within(t, PATCH))
    run["odometry"] = run["truth"] + np.column_stack([-1.5 * drift, drift, 0.4 * drift])
    for name in ("truth", "estimate", "odometry", "reference"):
        run[name][:, 2] = np.remainder(run[name][:, 2] + np.pi, 2 * np.pi) - np.pi
    curved = np.remainder(SPEED * t, 6 + 2 * np.pi)
    w = np.where(((curved > 3) & (curved < 3 + np.pi)) | (curved > 6 + np.pi), 0.5, 0.0)
    run["command"] = np.column_stack([SPEED + wander(rng, n, 0.01, 20), w + wander(rng, n, 0.02, 20)])
    return run | drives(t, run["command"], rng) | azimuths(t, rng) | frames_on_bus(duration, rng)


def _sawtooth(t: np.ndarray) -> np.ndarray:
    """Grows while the camera is lost."""
    return np.where(within(t, LOSS), (t - LOSS[0]) / LOSS[1], 0.0)


def drives(t: np.ndarray, command: np.ndarray, rng: np.random.Generator) -> Columns:
    fine = np.arange((len(t) - 1) * 10 + 1) * TICK
    run: Columns = {"tick/t": fine}
    for name, side in (("left", -1), ("right", 1)):
        reference = (command[:, 0] + side * TRACK / 2 * command[:, 1]) / RADIUS
        held = reference[np.minimum(np.arange(len(fine)) // 10, len(t) - 1)]
        loaded = within(fine, LOAD) if name == "left" else np.zeros(len(fine), bool)
        since = fine - LOAD[0]
        dip = np.where(loaded, -0.4 * since / 0.02 * np.exp(1 - since / 0.02), 0.0)
        ramp = np.minimum(fine / 0.3, 1.0)
        tick = {
            "speed": held * ramp + dip + rng.normal(size=len(fine)) * 0.01,
            "speed_ref": held * ramp,
            "load_torque": 3.0 * loaded,
            "torque": 0.3 + 3.0 * loaded + rng.normal(size=len(fine)) * 0.05,
            "current": 0.4 + 1.8 * loaded + rng.normal(size=len(fine)) * 0.05,
            "duty": 0.03 * held * ramp + 0.12 * loaded + rng.normal(size=len(fine)) * 0.002,
            "slip": 0.002 * rng.normal(size=len(fine)) + 0.08 * within(fine, PATCH) * (name == "right"),
        }
        for field, column in tick.items():
            run[f"tick/drive/{name}/{field}"] = column
            run[f"drive/{name}/{field}"] = column[::10]
        run[f"drive/{name}/speed_measured"] = np.roll(tick["speed"][::10], 1)
        run[f"drive/{name}/current_measured"] = np.roll(tick["current"][::10], 1)
    return run


def azimuths(t: np.ndarray, rng: np.random.Generator) -> Columns:
    shots = t[::10][~within(t[::10], LOSS)]
    exposure = np.repeat(shots, 2)
    beacon = np.where(rng.random(len(exposure)) < 0.03, -1, rng.integers(0, 4, len(exposure)))
    true = np.where(beacon < 0, np.nan, rng.uniform(-np.pi, np.pi, len(exposure)))
    measured = np.where(beacon < 0, 0.3, true + rng.normal(size=len(exposure)) * np.radians(0.008))
    return {
        "azimuth/t": exposure,
        "azimuth/delivered": exposure + 0.03,
        "azimuth/beacon": beacon,
        "azimuth/measured": measured,
        "azimuth/true": true,
        "nis/t": exposure,
        "nis/value": np.where(beacon < 0, 30.0, rng.chisquare(1, len(exposure))),
        "nis/dof": np.ones(len(exposure), np.int64),
        "nis/accepted": beacon >= 0,
    }


def frames_on_bus(duration: float, rng: np.random.Generator) -> Columns:
    count = int(duration * 700)
    t = np.sort(rng.random(count)) * duration
    return {
        "bus/t": t,
        "bus/latency": 230e-6 + rng.exponential(120e-6, count),
        "bus/duration": rng.uniform(180e-6, 230e-6, count),
        "bus/arbitration": rng.exponential(40e-6, count),
        "bus/error": np.zeros(count, np.int64),
        "bus/id": rng.choice(np.array([0x80, 0x181, 0x182, 0x201, 0x202, 0x281, 0x282]), count),
    }


CRITERIA = {
    "estimate_position_rms": CriterionSpec(max=0.05),
    "cross_track_rms": CriterionSpec(max=0.06),
    "odometry_over_estimate": CriterionSpec(min=5.0),
    "left.load_dip": CriterionSpec(max=0.25),
    "recovery": CriterionSpec(metric="load_recovery", drive="left", max=0.2),
}

SCENARIO = {
    "seed": 1,
    "duration": 60.0,
    "robot": {"kind": "diffdrive", "track": TRACK, "wheel_radius": RADIUS},
    "plant": {"kind": "bullet", "beacons": [{"at": list(at), "colour": name} for at, name in BEACONS]},
    "disturbances": [
        {"kind": "load_torque", "drive": "left", "start": LOAD[0], "length": LOAD[1], "size": 3.0},
        {"kind": "slip_patch", "start": PATCH[0], "length": PATCH[1]},
        {"kind": "camera_loss", "start": LOSS[0], "length": LOSS[1]},
    ],
    "versions": {"hilbed": "0.1.0"},
}


def picture(k: int) -> np.ndarray:
    """A grey arena with two beacons."""
    image = np.empty((64, 640, 3), np.uint8)
    image[:34] = np.linspace(205, 160, 34)[:, None, None]
    image[34:] = np.linspace(105, 130, 30)[:, None, None]
    for column, colour in ((120 + 15 * k, (220, 30, 30)), (480 - 9 * k, (30, 200, 60))):
        for row in range(14, 46):
            half = 2 + (row - 14) // 8
            image[row, column - half : column + half] = colour
    return image


def write(folder: Path, keep: Callable[[str], bool] = lambda _: True, reason: str = "") -> Path:
    """Writes a run folder with the signals whose names are wanted, without a report."""
    run = RunFolder(folder)
    run.start()
    kept = {name: column for name, column in signals().items() if keep(name)}
    notes = Notes()
    sinks: list[Sink] = [CandumpLog(folder / "can.log", 10**9), Frames(folder / "frames")]
    journal = Journal(notes, sinks, Cost(), Pose(0.0, 0.0, 0.0))
    if keep("bus/t"):
        for k in range(200):
            notes.transfer(Transfer(k, k, k * 10**7, Frame(0x181, bytes(8)), "left"))
    if keep("azimuth/t"):
        for k in range(12):
            pixels = (119.5 + 15 * k, 479.5 - 9 * k, 300.0)
            notes.snapshot(Snapshot(k * 5 * 10**9, picture(k), 0.1 * k, pixels, (0, 1, None)))
    journal.close()
    cost = {"physics": 0.9, "render": 1.1, "vision": 0.3, "bus": 0.3, "drives": 0.5,
            "estimator": 0.15, "controller": 0.1, "record": 0.4}  # fmt: skip
    end = float(kept["t"][-1]) if len(kept["t"]) else 0.0
    account = Account("demo", 1, reason, end, 4.1, cost, "3f2a" * 16, "77aa" * 16)
    run.write("scenario.yaml", yaml.safe_dump(SCENARIO, sort_keys=False))
    run.write("verdict.json", text(conclude(account, kept, CRITERIA)))
    run.write_signals(kept)
    return folder


if __name__ == "__main__":
    from hilbed.report import write_report

    print(write_report(write(Path(sys.argv[1]))))
