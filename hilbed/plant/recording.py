"""A recorded robot's file: numpy .npz, read without pickle and checked whole.

Rows are samples at times t, columns of `range` and `bearing` are beacons.

| key | shape | meaning |
|---|---|---|
| `t` | (N,) s | strictly increasing; any start |
| `v`, `omega` | (N,) m/s, rad/s | odometry; holds from its row's time to the next |
| `landmarks` | (B, 2) m | beacons in the map |
| `range` | (N, B) m | from the sensor; 0 or NaN: not seen; may be absent |
| `bearing` | (N, B) rad | in the robot's frame, from the sensor; NaN: not seen; may be absent |
| `truth` | (N, 3) m, m, rad | pose in the map; NaN: unknown; may be absent |
| `truth_valid` | (N,) | where truth holds; absent: where it is finite |
| `sensor_offset` | m | the sensor in the robot's frame: ahead, or (2,) ahead and left; absent: 0 |
| `range_variance`, `bearing_variance` | m², rad² | as given with the data; may be absent |

Other keys are ignored. At least one of `range` and `bearing` is needed.
"""

from __future__ import annotations

import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from hilbed.types import Array, ScenarioError

NEEDED = ("t", "v", "omega", "landmarks")
UNREADABLE = (OSError, ValueError, EOFError, RuntimeError, zipfile.BadZipFile, zlib.error)


@dataclass(frozen=True)
class Recording:
    """The arrays of the file; what was not seen or is not known is NaN.

    t (N,) s from the first row; v, omega (N,); landmarks (B, 2); range, bearing (N, B) or None;
    truth (N, 3); mount (m); variances by key, for those that the file has.
    """

    t: Array
    v: Array
    omega: Array
    landmarks: Array
    range: Array | None
    bearing: Array | None
    truth: Array
    mount: tuple[float, float]
    variances: Mapping[str, float]


def load(path: Path) -> Recording:
    """Reads and checks a file; raises ScenarioError that tells everything that is wrong with it."""
    arrays, problems = _read(path)
    if not problems:
        problems = _problems(arrays)
    if problems:
        raise ScenarioError("\n".join(f"{path.name}: {problem}" for problem in problems))
    return _recording(arrays)


def _read(path: Path) -> tuple[dict[str, Array], list[str]]:
    """Returns every array that is made of numbers, and what cannot be read."""
    arrays, problems = {}, []
    try:
        file = np.load(path, allow_pickle=False)
        if not isinstance(file, np.lib.npyio.NpzFile):
            return {}, ["is a single array; a recording is an .npz file with named arrays"]
        with file:
            for key in file.files:
                try:
                    arrays[key] = _numbers(file[key])
                except UNREADABLE as error:
                    problems.append(f"{key} is not an array of numbers ({error})")
    except UNREADABLE as error:
        return {}, [f"cannot be read as .npz ({error})"]
    return arrays, problems


def _numbers(array: npt.NDArray[Any]) -> Array:
    if array.dtype.kind not in "biuf":
        raise ValueError(f"its type is {array.dtype}")
    return array.astype(np.float64)


def _problems(arrays: Mapping[str, Array]) -> list[str]:
    missing = [f"{key} is missing" for key in NEEDED if key not in arrays]
    if "range" not in arrays and "bearing" not in arrays:
        missing.append("range and bearing are both missing; one of them is needed")
    if "t" not in arrays or "landmarks" not in arrays:
        return missing
    return missing + _wrong_shapes(arrays) + _wrong_values(arrays)


def _wrong_shapes(arrays: Mapping[str, Array]) -> list[str]:
    rows, beacons = arrays["t"].size, arrays["landmarks"].shape[:1]
    seen = (rows, *beacons)
    wanted = {
        "t": [(rows,)], "v": [(rows,)], "omega": [(rows,)], "landmarks": [(*beacons, 2)],
        "range": [seen], "bearing": [seen], "truth": [(rows, 3)], "truth_valid": [(rows,)],
        "sensor_offset": [(), (2,)], "range_variance": [()], "bearing_variance": [()],
    }  # fmt: skip
    return [
        f"{key} has shape {arrays[key].shape}, needed is {' or '.join(map(str, shapes))}"
        for key, shapes in wanted.items()
        if key in arrays and arrays[key].shape not in shapes
    ]


def _wrong_values(arrays: Mapping[str, Array]) -> list[str]:
    problems = [
        f"{key} holds a number that is not finite (first at index {np.argwhere(bad)[0].tolist()})"
        for key in ("t", "v", "omega", "landmarks", "sensor_offset")
        if key in arrays and (bad := ~np.isfinite(arrays[key])).any()
    ]
    problems += [f"{key} holds an infinite number" for key in ("range", "bearing") if _infinite(arrays, key)]
    problems += [
        f"{key} must be positive"
        for key in ("range_variance", "bearing_variance")
        if key in arrays and not np.all(arrays[key] > 0)
    ]
    if arrays["t"].size < 2:
        problems.append("t needs at least two rows")
    steps = np.diff(arrays["t"].ravel())
    if np.any(steps <= 0):
        problems.append(f"t does not increase from row {int(np.argmax(steps <= 0))} to the next")
    return problems


def _infinite(arrays: Mapping[str, Array], key: str) -> bool:
    return key in arrays and bool(np.isinf(arrays[key]).any())


def _recording(arrays: Mapping[str, Array]) -> Recording:
    t = arrays["t"]
    truth = arrays.get("truth", np.full((len(t), 3), np.nan))
    valid = np.isfinite(truth).all(axis=1) & (arrays.get("truth_valid", np.ones(len(t))) == 1)
    ranges = arrays.get("range")
    ahead, left = (*np.atleast_1d(arrays.get("sensor_offset", np.zeros(2))).tolist(), 0.0)[:2]
    return Recording(
        t=t - t[0],
        v=arrays["v"],
        omega=arrays["omega"],
        landmarks=arrays["landmarks"],
        range=None if ranges is None else np.where(ranges > 0, ranges, np.nan),
        bearing=arrays.get("bearing"),
        truth=np.where(valid[:, None], truth, np.nan),
        mount=(ahead, left),
        variances={k: float(arrays[k]) for k in ("range_variance", "bearing_variance") if k in arrays},
    )
