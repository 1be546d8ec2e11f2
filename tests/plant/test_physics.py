"""The plant against closed forms, with the limits of the first issue."""

import pytest

from hilbed.plant import checks


def test_rolling_without_slip_follows_wheel_rotation() -> None:
    roll = checks.rolling()
    assert abs(roll.distance) < 5e-4
    assert abs(roll.yaw) < 5e-4


@pytest.mark.parametrize(("friction", "yaw"), [(0.15, 0.0), (0.3, 0.7), (0.8, -2.0)])
def test_slip_begins_where_coulomb_says(friction: float, yaw: float) -> None:
    assert abs(checks.slip_onset(friction, yaw)) < 0.02


@pytest.mark.parametrize("share", [checks.SHARE, 3 * checks.SHARE])
def test_motor_step_response_is_the_matrix_exponential(share: float) -> None:
    speed, current = checks.motor_step(share)
    assert speed < 0.005
    assert current < 0.005


@pytest.mark.parametrize("load", [0.0, 0.5, 1.0])
def test_energy_of_motor_gear_and_load_is_accounted_for(load: float) -> None:
    books = checks.energy(load=load)
    assert books.supply > 5.0
    assert abs(books.error) < 0.01
