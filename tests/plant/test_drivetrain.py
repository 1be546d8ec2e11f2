"""Motor, gear and power stage against closed forms and brute force."""

from __future__ import annotations

from math import exp

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from hilbed.plant.chopper import Averaged, AveragedStage, Stage, Switched
from hilbed.plant.drivetrain import DriveTrain, reflected_inertia
from hilbed.plant.gear import EDGE, GEARS, Gear, GearSpec, transmitted
from hilbed.plant.motor import MOTORS, Motor, MotorSpec
from hilbed.plant.supply import Supply, SupplySpec
from hilbed.plant.switched import SwitchedStage
from hilbed.plant.winding import relax, through_diodes

DT = 1e-3
RE35, GP32C = MOTORS["re35"], GEARS["gp32c-33"]
R, L = RE35.resistance, RE35.inductance

amperes = st.floats(-14.0, 14.0)
duties = st.floats(-1.0, 1.0)
volts = st.floats(-20.0, 20.0)


def brute(current: float, volts: float, emf: tuple[float, float], steps: int = 20_000) -> tuple[float, ...]:
    """Integrates L di/dt = u − e − R i by the midpoint rule; e rises along emf. End, mean, mean square."""
    h, end, total, square = DT / steps, current, 0.0, 0.0
    for k in range(steps):
        e = emf[0] + (emf[1] - emf[0]) * (k + 0.5) / steps
        slope = (volts - e - R * end) / L
        middle = end + 0.5 * h * slope
        end += h * (volts - e - R * middle) / L
        total += middle
        square += middle * middle
    return end, total / steps, square / steps


def averaged(**spec: float) -> AveragedStage:
    return AveragedStage(Averaged.model_validate({"resistance": 0.0, "current_limit": 1e3, **spec}), R, L, DT)


@pytest.mark.parametrize(
    ("current", "duty", "emf"), [(0.0, 0.5, (0.0, 0.0)), (9.0, -0.3, (4.0, 4.0)), (2.0, 0.8, (8.0, 8.4))]
)
def test_averaged_tick_is_exact(current: float, duty: float, emf: tuple[float, float]) -> None:
    end, mean, supply, heat = averaged().drive(current, duty, 24.0, sum(emf) / 2, emf[1] - emf[0])
    oracle = brute(current, duty * 24.0, emf)
    assert (end, mean) == pytest.approx(oracle[:2], abs=1e-6)
    assert supply == pytest.approx(duty * mean)
    # Exact at constant EMF; a ramp enters the heat to first order only.
    assert heat == pytest.approx(R * oracle[2] * DT, rel=1e-6 if emf[0] == emf[1] else 3e-3)


@given(amperes, duties, volts, st.floats(5.0, 30.0), st.booleans())
def test_power_stage_conserves_energy(
    current: float, duty: float, emf: float, supply: float, enabled: bool
) -> None:
    for stage in (averaged(current_limit=15.0), switched(current_limit=15.0, dead_time=1e-6)):
        if enabled:
            end, mean, drawn, heat = stage.drive(current, duty, supply, emf, 0.0)
        else:
            end, mean, drawn, heat = stage.coast(current, supply, emf)
        stored = 0.5 * L * (end**2 - current**2)
        assert supply * drawn * DT == pytest.approx(heat + stored + emf * mean * DT, abs=1e-6)
        assert heat >= -1e-12


@given(amperes, duties, volts)
def test_no_current_above_the_limit(current: float, duty: float, emf: float) -> None:
    end, mean, *_ = averaged(current_limit=15.0).drive(current, duty, 24.0, emf, 0.0)
    assert abs(end) <= 15.0
    assert abs(mean) <= 15.0
    # Switch by switch, a driving current is cut at once, a braking one when its period is over.
    beyond = (20.0 + 1.0) / L / 20e3
    end, mean, *_ = switched(current_limit=15.0).drive(current, duty, 24.0, emf, 0.0)
    assert abs(end) <= 15.0 + beyond
    assert abs(mean) <= 15.0 + beyond


def test_limited_tick_rises_then_holds() -> None:
    end, mean, *_ = averaged(current_limit=10.0).drive(0.0, 1.0, 24.0, 0.0, 0.0)
    steps = np.linspace(0.0, DT, 200_001)
    free = 24.0 / R * (1.0 - np.exp(-steps * R / L))
    assert end == 10.0
    assert mean == pytest.approx(np.minimum(free, 10.0).mean(), rel=1e-5)


@given(amperes, volts)
def test_open_bridge_stops_the_current_at_zero(current: float, emf: float) -> None:
    end, mean, drawn, _ = averaged().coast(current, 24.0, emf)
    assert end == 0.0 or (end * current > 0.0 and abs(end) < abs(current))
    rounding = 1e-15  # A: the charge of a current that dies at once is a difference of equal numbers
    assert mean * current >= -rounding * abs(current)
    assert drawn == pytest.approx(-abs(mean))


def test_a_wheel_dragged_fast_without_supply_feeds_its_diodes() -> None:
    end, _, drawn, _ = averaged().coast(0.0, 0.0, 10.0)
    assert end < 0.0
    assert drawn < 0.0


def test_disabled_drive_coasts_without_torque() -> None:
    train = DriveTrain(MOTORS["re35"].model_copy(update={"viscous": 0.0}), GP32C, Averaged(), DT)
    for _ in range(50):
        train.step(0.4, True, 24.0, 5.0)
    train.step(0.4, False, 24.0, 5.0)
    assert train.current == 0.0
    assert train.step(0.4, False, 24.0, 5.0) == 0.0
    assert train.supply_current == 0.0


def test_braking_feeds_the_supply() -> None:
    train = DriveTrain(RE35, GP32C, Averaged(), DT)
    torque = [train.step(0.1, True, 24.0, 10.0) for _ in range(5)][-1]
    assert torque < 0.0
    assert train.supply_current < 0.0


# Gear


@given(st.floats(-50.0, 50.0))
def test_gear_never_makes_energy(along: float) -> None:
    factor = transmitted(0.25, 0.5, along)
    assert factor * along <= along
    assert transmitted(0.25, 0.5, along + 1e-9) == pytest.approx(factor, abs=1e-7)


def test_gear_losses_depend_on_the_direction_of_power() -> None:
    for speed, factor in ((5.0, 0.75), (-5.0, 1.0 / 0.667), (EDGE / 2, 0.875)):
        train = DriveTrain(RE35, GP32C, Averaged(), DT)
        train.step(1.0, True, 24.0, speed)
        torque = train.step(1.0, True, 24.0, speed)
        shaft = RE35.torque_constant * train.mean_current - RE35.viscous * 33.0 * speed
        assert torque == pytest.approx(33.0 * shaft * factor)


def test_reflected_inertia() -> None:
    assert reflected_inertia(RE35, GearSpec(ratio=10.0)) == pytest.approx(79.2e-5)


# Switched bridge


def switched(**spec: float) -> SwitchedStage:
    return SwitchedStage(Switched.model_validate({"resistance": 0.0, "current_limit": 1e3, **spec}), R, L, DT)


def settled(stage: Stage, duty: float, emf: float) -> tuple[float, ...]:
    tick: tuple[float, ...] = (0.0,)
    for _ in range(20):
        tick = stage.drive(tick[0], duty, 24.0, emf, 0.0)
    return tick


@pytest.mark.parametrize(("duty", "emf"), [(0.3, 5.0), (0.7, -3.0), (-0.45, -6.0), (0.5, 14.0), (1.0, 0.0)])
def test_switched_agrees_with_averaged_without_dead_time(duty: float, emf: float) -> None:
    stage = switched(dead_time=0.0)
    end, mean, drawn, _ = settled(stage, duty, emf)
    ideal = settled(averaged(), duty, emf)
    assert mean == pytest.approx(ideal[1], abs=1e-3)
    # Sampled in the ripple's middle, the current is its mean.
    assert end == pytest.approx(ideal[0], abs=0.02 * stage.ripple + 1e-9)
    # A triangle of current heats the winding with its own R ripple²/12; the supply pays.
    assert drawn * 24.0 == pytest.approx(ideal[2] * 24.0 + R * stage.ripple**2 / 12, abs=1e-3)


@pytest.mark.parametrize(("duty", "frequency"), [(0.5, 20e3), (0.25, 20e3), (0.6, 5e3)])
def test_ripple_is_the_closed_form(duty: float, frequency: float) -> None:
    stage = switched(dead_time=0.0, frequency=frequency)
    settled(stage, duty, 4.0)
    tau, period = L / R, 1.0 / frequency
    on, off = exp(-duty * period / tau), exp(-(1.0 - duty) * period / tau)
    assert stage.ripple == pytest.approx(24.0 / R * (1.0 - on) * (1.0 - off) / (1.0 - on * off), rel=1e-9)


def test_dead_time_takes_its_voltage() -> None:
    dead, frequency, drop = 1e-6, 20e3, 0.8
    lost = settled(switched(dead_time=0.0), 0.5, 5.0)[1] - settled(switched(dead_time=dead), 0.5, 5.0)[1]
    assert lost * R == pytest.approx(frequency * dead * (24.0 + 2.0 * drop), rel=1e-6)


def test_switched_tick_with_dead_time_is_brute_force() -> None:
    """A small current that dies within the dead time, against steps of 5 ns."""
    spec = Switched(resistance=0.0, dead_time=2e-6, current_limit=1e3)
    end, mean, *_ = SwitchedStage(spec, R, L, DT).drive(0.05, 0.2, 24.0, 4.7, 0.0)
    period, h, current, total = 50e-6, 5e-9, 0.05, 0.0
    on = 0.2 * period - spec.dead_time
    edges = np.cumsum([(period - on) / 2 - spec.dead_time, spec.dead_time, on, spec.dead_time])
    for k in range(round(DT / h)):
        phase = (k + 0.5) * h % period
        part = int(np.searchsorted(edges, phase))
        if part == 2:
            terminal = 24.0
        elif part in (0, 4):
            terminal = 0.0
        elif current > 0.0:
            terminal = -0.8
        elif current < 0.0:
            terminal = 24.8
        else:
            terminal = 4.7
        new = current + h * (terminal - 4.7 - R * current) / L
        current = 0.0 if part in (1, 3) and new * current < 0.0 else new
        total += current * h
    assert end == pytest.approx(current, abs=2e-3)
    assert mean == pytest.approx(total / DT, abs=2e-3)


@pytest.mark.parametrize(
    ("spec", "what"), [({"frequency": 1500.0}, "multiple"), ({"dead_time": 30e-6}, "fill the PWM period")]
)
def test_pwm_must_fit_the_tick(spec: dict[str, float], what: str) -> None:
    with pytest.raises(ValueError, match=what):
        switched(**spec)


# Winding


@given(amperes, amperes, st.floats(1e-6, 1e-2))
def test_relaxing_in_two_parts_is_relaxing_in_one(current: float, target: float, duration: float) -> None:
    end, charge, square = relax(current, target, L / R, duration)
    half = relax(current, target, L / R, 0.4 * duration)
    rest = relax(half[0], target, L / R, 0.6 * duration)
    assert rest[0] == pytest.approx(end, abs=1e-9)
    assert half[1] + rest[1] == pytest.approx(charge, abs=1e-12)
    assert half[2] + rest[2] == pytest.approx(square, abs=1e-11)


def test_diodes_block_between_their_rails() -> None:
    assert through_diodes(0.0, (-1.0, 1.0), R, L / R, DT) == (0.0, 0.0, 0.0)


# Data


def test_catalogue_names_and_blocks() -> None:
    motor = TypeAdapter(Motor)
    assert motor.validate_python("re35") is RE35
    assert motor.validate_python(RE35.model_dump()) == RE35
    with pytest.raises(ValidationError, match="no motor 're36' in the catalogue; there are re35"):
        motor.validate_python("re36")
    with pytest.raises(ValidationError, match="no gear 'gp'"):
        TypeAdapter(Gear).validate_python("gp")


def test_catalogue_motor_runs_as_its_data_sheet_says() -> None:
    """No-load current 168 mA at 7670 rpm; stall current 41 A; speed constant 328 rpm/V: all within 3 %."""
    speed = 7670.0 * 2.0 * np.pi / 60.0
    friction = RE35.coulomb + RE35.viscous * speed
    assert friction / RE35.torque_constant == pytest.approx(0.168, rel=0.03)
    assert pytest.approx(41.4, rel=0.03) == 24.0 / R
    assert 60.0 / (2.0 * np.pi * RE35.back_emf) == pytest.approx(328.0, rel=0.03)


def test_constants_that_make_energy_are_refused() -> None:
    with pytest.raises(ValidationError, match="same number"):
        MotorSpec.model_validate({**RE35.model_dump(), "back_emf": 0.02})


def test_supply_sags() -> None:
    supply = Supply(SupplySpec(voltage=24.0, resistance=0.1))
    assert supply.voltage(0.0, 0.0) == 24.0
    assert supply.voltage(10.0, 2.0) == pytest.approx(21.0)
    assert supply.voltage(-5.0, 0.0) == pytest.approx(24.5)
    assert supply.voltage(1e4, 0.0) == 0.0


def test_sagging_supply_settles_with_its_drives() -> None:
    """Two stalled motors behind 0.1 Ω: U = U₀ − 2 R_s a² U / R."""
    supply, trains = Supply(SupplySpec(resistance=0.1)), []
    trains = [DriveTrain(RE35, GP32C, Averaged(resistance=0.0), DT) for _ in range(2)]
    voltage = 24.0
    for _ in range(50):
        voltage = supply.voltage(sum(train.supply_current for train in trains), 0.0)
        for train in trains:
            train.step(0.3, True, voltage, 0.0)
    assert voltage == pytest.approx(24.0 / (1.0 + 2.0 * 0.1 * 0.3**2 / R), rel=1e-9)
