from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from hilbed.sensors.delivery import Delivery, DeliverySpec
from hilbed.types import Reading

RNG = np.random.default_rng


def reading(t: int, delivered: int) -> Reading:
    return Reading("azimuth", t, delivered, (0.0,), (0.1,))


@given(st.floats(0.1, 1000.0), st.floats(0.0, 1.0), st.lists(st.integers(0, 300), min_size=1, max_size=30))
def test_every_reading_comes_once_in_order_and_not_before_its_time(
    rate: float, latency: float, waits: list[int]
) -> None:
    delivery = Delivery(DeliverySpec(rate=rate, latency=latency), RNG(0))
    sent, got, now = [], [], 0
    for wait in waits:
        now += wait * 1_000_000
        while delivery.due <= now:
            t = delivery.due
            sent.append(reading(t, delivery.expose(t)))
            delivery.put(sent[-1:])
        fresh = delivery.read(now)
        assert all(r.delivered <= now for r in fresh)
        got += fresh
        assert [r for r in sent if r.delivered <= now] == got
    assert [r.delivered for r in got] == sorted(r.delivered for r in got)
    assert all(r.delivered - r.t == round(latency * 1e9) for r in sent)


def test_samples_are_due_at_whole_nanoseconds_and_do_not_drift() -> None:
    delivery = Delivery(DeliverySpec(rate=30.0), RNG(0))
    due = []
    for _ in range(3001):
        due.append(delivery.due)
        delivery.expose(delivery.due)
    assert due[:3] == [0, 33_333_333, 66_666_667]
    assert due[3000] == 100_000_000_000
    assert all(isinstance(t, int) for t in due)


def test_a_sample_taken_late_does_not_shift_the_next_and_skips_what_was_missed() -> None:
    delivery = Delivery(DeliverySpec(rate=10.0, latency=0.02), RNG(0))
    assert delivery.expose(700_000) == 20_700_000
    assert delivery.due == 100_000_000
    delivery.expose(350_000_000)
    assert delivery.due == 400_000_000


def test_loss_takes_whole_samples_at_its_probability() -> None:
    delivery = Delivery(DeliverySpec(rate=10.0, latency=0.0, loss=0.25), RNG(4))
    kept = sum(delivery.put([reading(t, t), reading(t, t)]) for t in range(4000))
    assert len(delivery.read(4000)) == 2 * kept
    assert kept / 4000 == pytest.approx(0.75, abs=0.03)


@pytest.mark.parametrize(
    "block", [{"rate": 0}, {"rate": 2000}, {"latency": -0.1}, {"loss": 1.5}, {"rates": 3}]
)
def test_a_delivery_that_cannot_be_is_refused(block: dict[str, float]) -> None:
    with pytest.raises(ValidationError):
        DeliverySpec.model_validate(block)
