from __future__ import annotations

import numpy as np

from hilbed.record.clouds import MOST, Clouds

PERIOD = 50_000_000


def noted(cycles: int, count: int) -> dict[str, np.ndarray]:
    clouds = Clouds()
    for k in range(cycles):
        cloud = np.full((count, 3), float(k))
        cloud[:, 1] = np.arange(count)
        clouds.note(k * PERIOD, cloud)
    return clouds.columns()


def test_clouds_are_kept_early_on_often_and_at_the_very_end() -> None:
    columns = noted(1401, 9)
    cycles = [0, 1, 2, 3, 5, 10, 20, 30, 50, 100, 200, 300, 500, 1000, 1400]
    assert np.allclose(columns["cloud/t"], 0.05 * np.array(cycles))
    assert columns["cloud/particles"].shape == (len(cycles), 9, 3)
    assert np.array_equal(columns["cloud/particles"][:, 4, 0], cycles)


def test_the_last_cloud_is_kept_once() -> None:
    assert np.allclose(noted(31, 1)["cloud/t"][-2:], [1.0, 1.5])


def test_a_large_cloud_is_thinned_evenly() -> None:
    for count, step in ((MOST, 1), (MOST + 1, 2), (2 * MOST, 2), (100_000, 100)):
        kept = noted(1, count)["cloud/particles"][0, :, 1]
        assert np.array_equal(kept, np.arange(0, count, step))
        assert len(kept) <= MOST


def test_an_estimate_without_a_cloud_leaves_no_column() -> None:
    clouds = Clouds()
    clouds.note(0, None)
    assert clouds.columns() == {}
