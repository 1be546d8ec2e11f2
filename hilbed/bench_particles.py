"""What particle filter and cloud control cost, for few and for many particles, side by side in one run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from math import pi
from time import thread_time
from typing import NamedTuple

import numpy as np

from hilbed.angles import wrap
from hilbed.clock import nanos
from hilbed.control.cloud import CloudControl
from hilbed.control.cloud_spec import CloudSpec
from hilbed.control.point import PointSpec
from hilbed.control.stabilisation import Gains, stabilising
from hilbed.control.support import most_supported
from hilbed.estimation.cloud import WayNoise, predicted
from hilbed.estimation.importance import importance, squared_distances
from hilbed.estimation.particle_filter import ParticleFilter
from hilbed.estimation.particle_spec import ParticleFilterSpec
from hilbed.estimation.resampling import multinomial
from hilbed.plant.kinematics import TwistNoise, advanced, rk4
from hilbed.rng import stream
from hilbed.types import Array, Command, Odometry, Pose, Reading

T = 0.05
START, GOAL = Pose(4.0, 0.0, pi), Pose(1.0, 3.0, -pi / 2)
NOISE = TwistNoise(0.005, 0.1745)
STD = (0.1, 0.1, pi / 180)
RADII = CloudSpec().radii
MOMENTS = {"first": 0, "middle": 50, "goal": 600}
"""Cycles at which clouds are taken: Fig. 9, Fig. 10 and 11, and where the robot has settled."""
MEMORY = 100  # cycles that a filter of another size is given to find its own cloud of a moment
BUDGET = 0.5  # s, for each number in the table
PAPER, FEW, MANY = 900, 1_000, 100_000


class Told(NamedTuple):
    """One cycle of a run as an estimator gets it, and where the run's own one then believed to be."""

    odometry: Odometry
    readings: list[Reading]
    belief: Pose


class Timed(NamedTuple):
    """One stage: s for 900, 1 000 and 100 000 particles; brute: s of all pairs at 900, for selections."""

    stage: str
    paper: float
    few: float
    many: float
    brute: float | None = None

    @property
    def growth(self) -> float:
        """How many times longer 100 000 particles take than 1 000."""
        return self.many / self.few


def told_run(cycles: int) -> list[Told]:
    """Returns a run of Lages & Alves (2017) with the guarded law; seed 1."""
    particles = ParticleFilter(ParticleFilterSpec(), START, stream(1, "estimator"))
    control = CloudControl(CloudSpec(), PointSpec(kind="point", pose=GOAL).build())
    plant, gps = stream(1, "plant"), stream(1, "gps")
    truth, u, told = START, Command(0.0, 0.0), []
    for k in range(cycles):
        t = nanos(k * T)
        odometry = Odometry(t, T * u.v, T * u.w, *u)
        readings = [_reading(t, truth, gps)] if k % 4 == 3 else []
        estimate = particles.step(t, odometry, readings)
        told.append(Told(odometry, readings, Pose(*estimate.mean.tolist())))
        u = control.step(t, estimate)
        truth = advanced(truth, NOISE.disturbed(u, plant), T, rk4, 4)
    return told


def _reading(t: int, truth: Pose, rng: np.random.Generator) -> Reading:
    x, y, yaw = np.add(truth, np.multiply(STD, rng.standard_normal(3))).tolist()
    return Reading("pose", t, t, (x, y, wrap(yaw)), STD)


def cloud_at(told: list[Told], k: int, count: int) -> Array:
    """Returns the cloud (count, 3) at cycle `k` of a filter that was started `MEMORY` cycles before."""
    begin = max(k - MEMORY, 0)
    particles = ParticleFilter(ParticleFilterSpec(particles=count), told[begin].belief, stream(1, "replay"))
    for odometry, readings, _ in told[begin : k + 1]:
        estimate = particles.step(odometry.t, odometry, readings)
    assert estimate.cloud is not None
    return estimate.cloud


def commands(cloud: Array, guard: float) -> tuple[Array, Array]:
    """Returns the commands (M,), (M,) of a cloud over the radii of the ellipse of support."""
    u1, u2 = stabilising(cloud, GOAL, Gains(guard=guard))
    return u1 / RADII[0], u2 / RADII[1]


def brute(x: Array, y: Array) -> Callable[[], object]:
    """Returns the count of support over all pairs, whose differences are at hand."""
    dx, dy = x[:, None] - x, y[:, None] - y
    return lambda: np.count_nonzero(dx * dx + dy * dy < 1, axis=1)


def seconds(work: Callable[[], object]) -> float:
    """Returns the time that a piece of work takes, the best of many tries within `BUDGET`.

    It is processor time of this thread, which does all the work: who else runs does not count.
    """
    work()
    times: list[float] = []
    while len(times) < 5 or (sum(times) < BUDGET and len(times) < 200):
        start = thread_time()
        work()
        times.append(thread_time() - start)
    return min(times)


def report() -> str:
    """Measures for some seconds and returns the table."""
    told = told_run(max(MOMENTS.values()) + 1)
    return table(list(measured(told)), cycle_times(told))


def cycle_times(told: list[Told]) -> list[float]:
    """Returns the s of each cycle of estimator and controller at 900 particles, over the run."""
    particles = ParticleFilter(ParticleFilterSpec(), START, stream(1, "estimator"))
    control = CloudControl(CloudSpec(), PointSpec(kind="point", pose=GOAL).build())
    times = []
    for odometry, readings, _ in told:
        start = thread_time()
        control.step(odometry.t, particles.step(odometry.t, odometry, readings))
        times.append(thread_time() - start)
    return times


def measured(told: list[Told]) -> Iterator[Timed]:
    """Yields every stage as it has been measured on the clouds of a run."""
    clouds = {name: [cloud_at(told, k, m) for m in (PAPER, FEW, MANY)] for name, k in MOMENTS.items()}
    rng, noise = stream(1, "bench"), WayNoise()
    middle = told[MOMENTS["middle"]].belief

    def update(cloud: Array) -> Array:
        weights = importance(squared_distances(cloud, middle, STD))
        assert weights is not None
        return cloud.T[:, multinomial(weights, rng)].T

    stages: dict[str, Callable[[Array], object]] = {
        "predict": lambda cloud: predicted(cloud, 0.02, 0.01, noise, rng),
        "update": update,
        "law": lambda cloud: stabilising(cloud, GOAL, Gains()),
    }
    for stage, work in stages.items():
        yield Timed(stage, *(seconds(partial(work, cloud)) for cloud in clouds["middle"]))
    for name, guard in [(name, Gains().guard) for name in MOMENTS] + [("goal, printed law", 0.0)]:
        xys = [commands(cloud, guard) for cloud in clouds[name.split(",")[0]]]
        paper, few, many = (seconds(partial(most_supported, *xy)) for xy in xys)
        yield Timed(f"selection, {name}", paper, few, many, seconds(brute(*xys[0])))


def table(stages: list[Timed], cycles: list[float]) -> str:
    """Returns the stages as lines of text, and the whole cycle (s) at 900 particles."""
    lines = [f"{'particles':34}{PAPER:>9}{FEW:>9}{MANY:>9}{'growth':>9}{'all pairs':>11}{'of them':>9}"]
    for timed in stages:
        times = "".join(f"{1e3 * t:9.3f}" for t in timed[1:4])
        pairs = f"{1e3 * timed.brute:11.3f}{timed.paper / timed.brute:9.2f}" if timed.brute else ""
        lines.append(f"{timed.stage + ', ms':34}{times}{timed.growth:9.0f}{pairs}")
    fixed = sum(timed.paper for timed in stages if timed.brute is None)
    worst = max(timed.paper for timed in stages if timed.brute is not None)
    lines.append(f"predict, update, law and the slowest selection at {PAPER}: {1e3 * (fixed + worst):.2f} ms")
    typical, slow = 1e3 * np.quantile(cycles, (0.5, 0.95))
    whole = f"the whole cycle of estimator and controller at {PAPER}, over {len(cycles)} cycles of a run"
    lines.append(f"{whole}: {typical:.2f} ms (median), {slow:.2f} ms (95 %); the paper: 1370 ms")
    return "\n".join(lines)
