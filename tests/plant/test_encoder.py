"""Encoder and pins: whole numbers that wrap and clip."""

from math import floor, pi, tau

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.plant import pins
from hilbed.plant.encoder import Encoder, EncoderSpec
from hilbed.types import ScenarioError


@given(st.floats(-1e7, 1e7), st.integers(1, 1_000_000))
def test_counts_wrap_as_i32(angle: float, resolution: int) -> None:
    count = Encoder(EncoderSpec(resolution=resolution), 1e-3).sample(angle)
    whole = floor(angle * (resolution / tau))
    assert -(2**31) <= count < 2**31
    assert (count - whole) % 2**32 == 0


def test_one_turn_is_the_resolution() -> None:
    encoder = Encoder(EncoderSpec(), 1e-3)
    assert encoder.sample(2.0 * pi + 1e-6) == 66_000
    assert encoder.sample(-1e-6) == -1


def test_latency_delays_by_whole_ticks() -> None:
    encoder = Encoder(EncoderSpec(resolution=1000, latency=0.003), 1e-3)
    turns = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    assert [encoder.sample(tau * turn + 1e-6) for turn in turns] == [0, 0, 0, 0, 1000, 2000]


def test_latency_between_ticks_is_refused() -> None:
    with pytest.raises(ScenarioError, match=r"encoder latency 0\.0015 s: not a multiple"):
        Encoder(EncoderSpec(latency=0.0015), 1e-3)


@pytest.mark.parametrize(("amperes", "pin"), [(1.2344, 1234), (-0.0006, -1), (40.0, 32767), (-40.0, -32768)])
def test_current_pin(amperes: float, pin: int) -> None:
    assert pins.current(amperes) == pin


@pytest.mark.parametrize(("volts", "pin"), [(24.0, 96), (23.9, 96), (0.0, 0), (-1.0, 0), (80.0, 255)])
def test_supply_pin(volts: float, pin: int) -> None:
    assert pins.supply(volts) == pin


@pytest.mark.parametrize(("q15", "duty"), [(32767, 1.0), (-32767, -1.0), (-32768, -1.0), (0, 0.0)])
def test_duty_pin(q15: int, duty: float) -> None:
    assert pins.duty(q15) == duty
