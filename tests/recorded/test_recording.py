from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hilbed.plant.recording import load
from hilbed.types import ScenarioError
from tests.recorded.files import arrays, write


def test_a_file_comes_back_as_written(tmp_path: Path) -> None:
    recording, table = load(write(tmp_path)), arrays()
    np.testing.assert_allclose(recording.t, np.arange(10) / 10)
    np.testing.assert_array_equal(recording.v, table["v"])
    assert recording.mount == (0.2, 0.0)
    assert recording.range is not None
    assert np.isnan(recording.range[:, 1]).all(), "range 0 is not seen"
    assert np.isnan(recording.truth[3]).all(), "truth that is not valid is unknown"
    np.testing.assert_array_equal(recording.truth[4], table["truth"][4])


def test_what_may_be_absent_has_defaults(tmp_path: Path) -> None:
    optional = ("range", "truth", "truth_valid", "sensor_offset", "range_variance", "bearing_variance")
    recording = load(write(tmp_path, **dict.fromkeys(optional)))
    assert recording.range is None
    assert recording.mount == (0.0, 0.0)
    assert np.isnan(recording.truth).all()
    assert recording.variances == {}
    assert load(write(tmp_path, sensor_offset=np.array([0.1, -0.2]))).mount == (0.1, -0.2)


def spoilt(key: str, index: Any, value: float) -> dict[str, Any]:
    array = np.array(arrays()[key], dtype=float)
    array[index] = value
    return {key: array}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"t": None}, ["t is missing"]),
        ({"v": None, "landmarks": None}, ["v is missing", "landmarks is missing"]),
        ({"range": None, "bearing": None}, ["range and bearing are both missing"]),
        ({"v": np.zeros(9)}, [r"v has shape \(9,\), needed is \(10,\)"]),
        ({"landmarks": np.zeros((2, 3))}, [r"landmarks has shape \(2, 3\), needed is \(2, 2\)"]),
        ({"landmarks": np.array(1.0)}, ["landmarks has shape"]),
        ({"t": np.zeros((5, 2))}, ["t has shape"]),
        ({"t": np.zeros(0)}, ["at least two rows"]),
        (
            {"bearing": np.zeros((10, 3)), "truth": np.zeros((10, 2))},
            ["bearing has shape", "truth has shape"],
        ),
        ({"sensor_offset": np.zeros(3)}, ["sensor_offset has shape"]),
        (spoilt("v", 4, np.nan), [r"v holds a number that is not finite \(first at index \[4\]\)"]),
        (spoilt("t", 4, np.inf), ["t holds a number that is not finite"]),
        (spoilt("landmarks", (0, 1), np.nan), ["landmarks holds"]),
        (spoilt("range", (2, 0), np.inf), ["range holds an infinite"]),
        (spoilt("t", 4, 5.3), ["t does not increase from row 3 to the next"]),
        ({"bearing_variance": np.array(0.0)}, ["bearing_variance must be positive"]),
        ({"v": np.array(["fast"] * 10)}, ["v is not an array of numbers"]),
        ({"v": np.array([{}] * 10, dtype=object)}, ["v is not an array of numbers"]),
        ({"v": np.array([[1], [2]], dtype=complex)}, ["v is not an array of numbers"]),
    ],
)
def test_everything_wrong_is_told_at_once(tmp_path: Path, changes: dict[str, Any], words: list[str]) -> None:
    path = write(tmp_path, **changes)
    for word in words:
        with pytest.raises(ScenarioError, match=rf"robot\.npz: .*{word}"):
            load(path)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 not really", b"\x93NUMPY", b"a,b\n1,2\n"])
def test_files_of_another_kind_are_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "robot.npz"
    path.write_bytes(content)
    with pytest.raises(ScenarioError, match="cannot be read"):
        load(path)


def test_a_truncated_file_and_a_missing_one_are_refused(tmp_path: Path) -> None:
    path = write(tmp_path)
    path.write_bytes(path.read_bytes()[:-300])
    with pytest.raises(ScenarioError, match="cannot be read"):
        load(path)
    with pytest.raises(ScenarioError, match="cannot be read"):
        load(tmp_path / "none.npz")


def test_a_damaged_array_is_refused(tmp_path: Path) -> None:
    path = write(tmp_path)
    content = bytearray(path.read_bytes())
    content[200] ^= 0xFF
    path.write_bytes(bytes(content))
    with pytest.raises(ScenarioError, match=r"not an array of numbers|cannot be read"):
        load(path)


def test_a_single_array_is_refused(tmp_path: Path) -> None:
    with (tmp_path / "robot.npz").open("wb") as file:
        np.save(file, np.zeros(3))
    with pytest.raises(ScenarioError, match="single array"):
        load(tmp_path / "robot.npz")
