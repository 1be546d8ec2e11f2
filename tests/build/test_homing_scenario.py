"""The bundled scenario of the steering axis: homed by its switch, told angles in profile position mode."""

from __future__ import annotations

import numpy as np
import pytest

from tests.bench import ran

NAME, SHORT = "tricycle/homing", "duration=4"


def off(*settings: str) -> float:
    """Returns by how much (rad) the axis is from its reference, median of the second half."""
    signals = ran(NAME, SHORT, *settings).signals
    angle, wanted = (signals[f"drive/steering/{key}"] for key in ("angle", "angle_ref"))
    return float(np.median(np.abs(angle - wanted)[len(angle) // 2 :]))


def test_with_its_switch_the_axis_stands_where_it_is_told() -> None:
    assert off() < 0.005


def test_without_it_every_angle_is_wrong_by_where_it_stood_at_power_on() -> None:
    assert off("nodes.steering.homing=37") == pytest.approx(0.3, abs=0.01)
