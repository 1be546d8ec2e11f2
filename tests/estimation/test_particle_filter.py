from __future__ import annotations

from math import cos, inf, nan, pi, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import truncnorm

from hilbed.estimation.particle_filter import ParticleFilter
from hilbed.estimation.particle_spec import ParticleFilterSpec
from hilbed.types import Estimate, Odometry, Pose, Reading

PERIOD = 50_000_000
START = Pose(1.0, 2.0, 0.5)
STD = (0.1, 0.1, pi / 180)
STILL = Odometry(0, 0.0, 0.0, 0.0, 0.0)


def make(seed: int = 1, start: Pose = START, **settings: object) -> ParticleFilter:
    spec = ParticleFilterSpec.model_validate(settings)
    return ParticleFilter(spec, start, np.random.default_rng(seed))


def pose_reading(t: int, value: tuple[float, ...], std: tuple[float, ...] = STD) -> Reading:
    return Reading("pose", t, t, value, std)


def driving(t: int, distance: float = 0.02, turn: float = 0.01) -> Odometry:
    return Odometry(t, distance, turn, distance / 0.05, turn / 0.05)


@pytest.mark.parametrize("resampling", ["multinomial", "systematic"])
def test_one_reading_gives_the_posterior_of_a_uniform_prior(resampling: str) -> None:
    """A truncated normal in x and in y; the cloud has about 1500 effective particles, bounds are 4 sigma."""
    value = (START.x + 0.45, START.y - 0.1, START.yaw)
    estimate = make(particles=40_000, resampling=resampling).step(0, STILL, [pose_reading(0, value)])
    for k, offset in enumerate((0.45, -0.1)):
        edges = (-0.5 - offset) / STD[k], (0.5 - offset) / STD[k]
        mean, variance = truncnorm.stats(*edges, loc=value[k], scale=STD[k])
        assert estimate.mean[k] == pytest.approx(mean, abs=4 * (variance / 1500) ** 0.5)
        assert estimate.covariance[k, k] == pytest.approx(variance, rel=0.15)
    assert estimate.mean[2] == pytest.approx(START.yaw)


def test_a_position_alone_is_a_reading_too() -> None:
    reading = Reading("position", 0, 0, (1.2, 2.1), (0.05, 0.05))
    estimate = make(particles=10_000).step(0, STILL, [reading])
    assert estimate.mean[:2] == pytest.approx((1.2, 2.1), abs=0.01)
    assert estimate.innovations[0].dof == 2


def test_a_told_standard_deviation_may_be_replaced() -> None:
    own = make(position_std=0.1, yaw_std=pi / 180).step(0, STILL, [pose_reading(0, START, (9, 9, 9))])
    told = make().step(0, STILL, [pose_reading(0, START)])
    assert own.cloud is not None
    assert told.cloud is not None
    np.testing.assert_array_equal(own.cloud, told.cloud)


def test_same_seed_same_cloud_to_the_bit_and_another_seed_another() -> None:
    def run(seed: int) -> Estimate:
        particles = make(seed)
        for k in range(9):
            t = k * PERIOD
            estimate = particles.step(t, driving(t), [pose_reading(t, START)] if k % 4 == 3 else [])
        return estimate

    first, second, other = run(1), run(1), run(2)
    assert first.cloud is not None
    assert other.cloud is not None
    np.testing.assert_array_equal(first.cloud, second.cloud)
    np.testing.assert_array_equal(first.mean, second.mean)
    assert not np.array_equal(first.cloud, other.cloud)


def test_what_has_been_handed_out_does_not_change() -> None:
    particles = make()
    estimate = particles.step(0, STILL, [])
    assert estimate.cloud is not None
    before = estimate.cloud.copy()
    particles.step(PERIOD, driving(PERIOD), [pose_reading(PERIOD, START)])
    np.testing.assert_array_equal(estimate.cloud, before)


def test_effective_sample_size_is_that_of_the_last_reading() -> None:
    particles = make()
    assert np.isnan(particles.effective)
    particles.step(0, STILL, [pose_reading(0, START, (50.0, 50.0, 1.0))])
    assert particles.effective == pytest.approx(900, rel=1e-3)
    particles.step(0, STILL, [pose_reading(0, START, (0.01, 0.01, 1.0))])
    assert 1 <= particles.effective < 10


def test_a_reading_that_gives_every_particle_zero_leaves_the_cloud_and_is_told() -> None:
    particles = make()
    before = particles.step(0, STILL, []).cloud
    estimate = particles.step(0, STILL, [pose_reading(0, (50.0, 2.0, 0.5))])
    np.testing.assert_array_equal(estimate.cloud, before)
    assert particles.unexplained == 1
    assert [i.accepted for i in estimate.innovations] == [False]
    assert estimate.innovations[0].nis > 1000


def test_after_some_in_a_row_the_cloud_is_drawn_round_the_reading() -> None:
    far = pose_reading(0, (50.0, 2.0, -3.0))
    particles = make(recover_after=3)
    for _ in range(2):
        particles.step(0, STILL, [far])
    particles.step(0, STILL, [pose_reading(0, START)])  # one that is believed starts the count again
    estimates = [particles.step(0, STILL, [far]) for _ in range(3)]
    assert particles.recovered == 1
    assert estimates[1].mean[0] < 2
    np.testing.assert_allclose(estimates[2].mean, far.value, atol=0.02)
    np.testing.assert_allclose(np.sqrt(np.diag(estimates[2].covariance)), STD, rtol=0.15)


def test_a_filter_that_never_recovers_never_does() -> None:
    particles = make(recover_after=None)
    for _ in range(50):
        estimate = particles.step(0, STILL, [pose_reading(0, (50.0, 2.0, 0.5))])
    assert particles.unexplained == 50
    assert estimate.mean[0] == pytest.approx(START.x)


@pytest.mark.parametrize(("late", "through"), [(0, 0), (2 * PERIOD, 2), (2 * PERIOD + PERIOD // 4, 2.25)])
def test_a_late_reading_is_compared_with_where_the_robot_was(late: int, through: float) -> None:
    """On a straight line at 0.4 m/s without noise; the reading has the exact pose of its exposure."""
    particles = make(side=0.2, along_noise=0.0, turn_noise=0.0, particles=2500)
    for k in range(1, 9):
        t = k * PERIOD
        estimate = particles.step(t, driving(t, 0.02, 0.0), [])
    way = 0.02 * (8 - through)
    seen = (START.x + way * cos(START.yaw), START.y + way * sin(START.yaw), START.yaw)
    reading = Reading("pose", t - late, t, seen, (0.02, 0.02, 0.01))
    estimate = particles.step(t, Odometry(t, 0.0, 0.0, 0.4, 0.0), [reading])
    truth = (START.x + 0.16 * cos(START.yaw), START.y + 0.16 * sin(START.yaw), START.yaw)
    np.testing.assert_allclose(estimate.mean, truth, atol=0.003)
    assert estimate.innovations[0].nis < 0.1


def test_beyond_its_odometry_the_cloud_is_extrapolated() -> None:
    particles = make(along_noise=0.0, turn_noise=0.0)
    estimate = particles.step(3 * PERIOD, driving(PERIOD, 0.02, 0.01), [])
    steps = np.cumsum([0.01] * 3)
    way = 0.02 * np.array((np.cos(START.yaw + steps - 0.005).sum(), np.sin(START.yaw + steps - 0.005).sum()))
    np.testing.assert_allclose(estimate.mean[:2], way + START[:2], atol=1e-5)
    assert estimate.mean[2] == pytest.approx(START.yaw + 0.03)


@pytest.mark.parametrize(
    "reading",
    [
        pose_reading(0, (nan, 0.0, 0.0)),
        pose_reading(0, (inf, 0.0, 0.0)),
        pose_reading(0, (1.0, 2.0, 1e9)),
        pose_reading(0, START, (0.1, nan, 0.1)),
        pose_reading(0, START, (0.1, 0.0, 0.1)),
        pose_reading(0, START, (0.1, -0.1, 0.1)),
        pose_reading(0, START, (0.1, 0.1)),
        pose_reading(0, (), ()),
        Reading("azimuth", 0, 0, (0.1,), (0.1,), 0),
        pose_reading(PERIOD, START),
        pose_reading(-(10**10), START),
    ],
)
def test_unusable_readings_are_counted_and_change_nothing(reading: Reading) -> None:
    particles, untouched = make(), make()
    estimate = particles.step(0, STILL, [reading])
    assert particles.ignored == 1
    assert estimate.innovations == ()
    np.testing.assert_array_equal(estimate.cloud, untouched.step(0, STILL, []).cloud)


@pytest.mark.parametrize("way", [(nan, 0.0), (0.0, nan), (inf, 0.0), (1e9, 0.0)])
def test_unusable_odometry_is_counted_and_its_speeds_bridge_the_gap(way: tuple[float, float]) -> None:
    particles = make()
    estimate = particles.step(PERIOD, Odometry(PERIOD, *way, 0.5, 0.0), [])
    assert particles.ignored == 1
    assert np.hypot(*(estimate.mean[:2] - START[:2])) == pytest.approx(0.025)
    estimate = particles.step(PERIOD, Odometry(PERIOD, *way, nan, 0.0), [])
    assert particles.ignored == 2
    assert estimate.mean == pytest.approx(START)


anything = st.one_of(st.floats(), st.sampled_from([nan, inf, -inf, 0.0, 1e300, -1e300, 1e-300]))
stamps = st.integers(-(10**12), 10**12)
wild_readings = st.builds(
    Reading,
    st.sampled_from(["pose", "position", "azimuth"]),
    stamps,
    stamps,
    st.lists(anything, max_size=4).map(tuple),
    st.lists(anything, max_size=4).map(tuple),
)


@settings(max_examples=100)
@given(
    st.lists(st.tuples(stamps, anything, anything, anything, anything), min_size=1, max_size=6),
    st.lists(wild_readings, max_size=6),
)
def test_nothing_that_arrives_raises_or_spoils_the_cloud(
    ways: list[tuple[int, float, float, float, float]], wild: list[Reading]
) -> None:
    particles = make(particles=30, recover_after=1)
    for k, way in enumerate(ways):
        estimate = particles.step(k * PERIOD, Odometry(*way), wild)
        assert estimate.cloud is not None
        assert np.isfinite(estimate.cloud).all()
        assert np.abs(estimate.cloud[:, 2]).max() <= pi
        assert np.isfinite(estimate.mean).all()
        assert np.isfinite(estimate.covariance).all()
