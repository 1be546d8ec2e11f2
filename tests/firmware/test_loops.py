"""The speed loops by themselves: closed forms, limits, and the numbers to reach on the test's own motor."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from firmware_sim.dictionary import ObjectDictionary
from firmware_sim.entry import key
from firmware_sim.error_rate import ErrorRate, smoothing
from firmware_sim.loops import FixedPi, Gains, Relay, RelayGains, SpeedLoop, VariableStructurePi
from firmware_sim.motor_model import MotorModel
from firmware_sim.speedmeter import Speedmeter
from tests.firmware.motor import COUNTS, VOLTAGE, Wheel

LOOPS: dict[str, Callable[[], SpeedLoop]] = {
    "variable structure": lambda: VariableStructurePi(Gains()),
    "fixed": lambda: FixedPi(Gains()),
    "relay": lambda: Relay(Gains(), RelayGains()),
}
MODEL = MotorModel(0.583, 0.0292 * 33, 10.0)


class Run(NamedTuple):
    speed: npt.NDArray[np.float64]
    duty: npt.NDArray[np.float64]
    current: npt.NDArray[np.float64]


def run(loop: SpeedLoop, loads: dict[int, float], ticks: int, reference: float = 5.0) -> Run:
    """Runs a loop on the motor from rest; loads: N m from a tick on."""
    wheel, meter = Wheel(), Speedmeter(COUNTS, 0.002)
    rows = []
    for k in range(ticks):
        wheel.load = loads.get(k, wheel.load)
        speed = meter.step(wheel.counts)
        duty = loop.step(reference, speed, *MODEL.window(speed, VOLTAGE))
        rows.append((wheel.speed, duty, wheel.current))
        wheel.tick(duty)
    return Run(*np.array(rows).T)


class Response(NamedTuple):
    dip: float  # rad/s
    recovery: int  # ms until within 2 % for good


def under_load(loop: SpeedLoop) -> Response:
    speed = run(loop, {1000: 3.0}, 2000).speed[1000:]
    outside = np.nonzero(np.abs(speed - 5.0) > 0.1)[0]
    return Response(5.0 - speed.min(), int(outside[-1]) + 1)


def test_load_torque() -> None:
    sliding, fixed = under_load(LOOPS["variable structure"]()), under_load(LOOPS["fixed"]())
    assert sliding.dip <= 0.25
    assert sliding.recovery <= 80
    assert fixed.dip >= 2 * sliding.dip
    assert fixed.recovery >= 2 * sliding.recovery


@pytest.mark.parametrize("load", [0.0, 3.0])
def test_chatter(load: float) -> None:
    assert run(LOOPS["variable structure"](), {0: load}, 1500).duty[1000:].std() < 0.005


def test_the_defaults_are_those_of_the_dictionary() -> None:
    values = ObjectDictionary(1).values
    assert [values[key(0x2010, sub)] for sub in range(2, 12)] == pytest.approx(list(Gains()))
    assert [values[key(0x2011, sub)] for sub in range(1, 4)] == pytest.approx(list(RelayGains()))


def test_a_relay_chatters() -> None:
    assert run(LOOPS["relay"](), {}, 1500).duty[1000:].std() > 0.05


def test_a_step_overshoots_by_less_than_a_percent_and_keeps_the_current() -> None:
    response = run(LOOPS["variable structure"](), {}, 1500)
    assert response.speed.max() < 5.05
    assert response.speed[-1] == pytest.approx(5.0, abs=0.02)
    assert np.abs(response.current).max() <= 10.5


def test_a_reversal_keeps_the_current() -> None:
    loop = LOOPS["variable structure"]()
    wheel, meter = Wheel(), Speedmeter(COUNTS, 0.002)
    most = 0.0
    for k in range(2000):
        speed = meter.step(wheel.counts)
        wheel.tick(loop.step(15.0 if k < 1000 else -15.0, speed, *MODEL.window(speed, VOLTAGE)))
        most = max(most, abs(wheel.current))
    assert most <= 10.5
    assert wheel.speed == pytest.approx(-15.0, abs=0.1)


@pytest.mark.parametrize("kind", LOOPS)
def test_every_loop_holds_the_speed(kind: str) -> None:
    speed = run(LOOPS[kind](), {1000: 3.0}, 2500).speed
    assert speed[900:1000].mean() == pytest.approx(5.0, abs=0.05)
    assert speed[2400:].mean() == pytest.approx(5.0, abs=0.05)


@given(
    kind=st.sampled_from(list(LOOPS)),
    steps=st.lists(st.tuples(st.floats(-1e7, 1e7), st.floats(-1e7, 1e7)), min_size=1, max_size=50),
    low=st.floats(-1.0, 0.0),
    width=st.floats(0.0, 1.0),
)
def test_the_duty_never_leaves_its_bounds(
    kind: str, steps: list[tuple[float, float]], low: float, width: float
) -> None:
    loop = LOOPS[kind]()
    for ref, speed in steps:
        assert low <= loop.step(ref, speed, low, low + width) <= low + width


@given(ref=st.floats(-20, 20), speed=st.floats(-20, 20), duty=st.floats(-0.5, 0.5))
def test_pi_loops_start_without_a_bump(ref: float, speed: float, duty: float) -> None:
    for kind in ("variable structure", "fixed"):
        loop = LOOPS[kind]()
        loop.reset(speed, speed, duty)
        assert loop.step(speed, speed) == pytest.approx(duty, abs=1e-9)
    loop = FixedPi(Gains())
    loop.reset(ref, speed, duty)
    assert loop.step(ref, speed) == pytest.approx(duty, abs=1e-9)


@given(st.lists(st.floats(-10, 10), min_size=1, max_size=30))
def test_without_its_rises_the_variable_structure_is_the_fixed_pi(speeds: list[float]) -> None:
    one, other = VariableStructurePi(Gains(kp_rise=0.0, ki_rise=0.0)), FixedPi(Gains())
    for speed in speeds:
        assert one.step(5.0, speed) == other.step(5.0, speed)


@given(st.lists(st.tuples(st.floats(-10, 10), st.floats(-10, 10)), min_size=1, max_size=30))
def test_loops_know_no_direction(steps: list[tuple[float, float]]) -> None:
    for make in LOOPS.values():
        one, mirrored = make(), make()
        for ref, speed in steps:
            assert one.step(ref, speed) == -mirrored.step(-ref, -speed)


def test_the_rate_of_a_ramp_and_the_silence_of_a_jump() -> None:
    rate = ErrorRate(0.005)
    for k in range(100):
        slope = rate.step(0.01 * k, 0.0)
    assert slope == pytest.approx(10.0, rel=1e-6)
    rate.reset(0.0, 0.0)
    assert rate.step(5.0, 0.0) == 0.0
    assert rate.step(5.0, 0.001) == pytest.approx(-smoothing(0.005))


@given(st.integers(-(2**31), 2**31 - 1), st.integers(-100_000, 100_000))
def test_the_speedmeter_reads_over_the_wrap(start: int, step: int) -> None:
    meter = Speedmeter(66_000, 0.0)
    meter.step(start)
    wrapped = (start + step + 2**31) % 2**32 - 2**31
    assert meter.step(wrapped) == pytest.approx(step / 66_000 * math.tau * 1000)


@given(st.floats(-100, 100), st.floats(0, 64))
def test_the_window_is_where_the_model_keeps_its_current(speed: float, voltage: float) -> None:
    low, high = MODEL.window(speed, voltage)
    assert -1.0 <= low <= high <= 1.0
    for duty in (low, high):
        current = (duty * max(voltage, 1.0) - MODEL.emf * speed) / MODEL.resistance
        against = duty in (-1.0, 1.0) and abs(MODEL.emf * speed) > max(voltage, 1.0)
        assert abs(current) <= MODEL.limit * (1 + 1e-9) or against
