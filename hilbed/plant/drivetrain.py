"""A drive from duty to torque at the wheel: chopper, motor and gear."""

from __future__ import annotations

from hilbed.plant.chopper import Averaged, AveragedStage, Stage, Switched
from hilbed.plant.gear import GearSpec, transmitted
from hilbed.plant.motor import MotorSpec
from hilbed.plant.switched import SwitchedStage


def reflected_inertia(motor: MotorSpec, gear: GearSpec) -> float:
    """Returns rotor and gear inertia as the wheel feels it (kg m²): it belongs into the wheel's spin."""
    return (motor.rotor_inertia + gear.inertia) * gear.ratio**2


def stage_of(chopper: Averaged | Switched, motor: MotorSpec, dt: float) -> Stage:
    """Builds the power stage that feeds the motor's winding."""
    if isinstance(chopper, Switched):
        return SwitchedStage(chopper, motor.resistance, motor.inductance, dt)
    return AveragedStage(chopper, motor.resistance, motor.inductance, dt)


# V of back-EMF by which a first guess may be off before it is mended: 2 mA in a 0.6 Ω winding.
GUESS = 1e-3


class DriveTrain:
    """Turns a duty into torque at the wheel, one tick at a time.

    After a step: `current` (A, end of tick), `mean_current` (A, over the tick; what makes the torque),
    `supply_current` (A, mean out of the supply), `heat` (J, in winding and bridge). `coulomb` (N m at the
    wheel) is friction that the world applies, for it must stop at zero; the rotor's inertia is the world's
    too (`reflected_inertia`).
    """

    __slots__ = (
        "_driven_gain", "_driving_loss", "_emf", "_last", "_pull", "_ratio", "_torque_constant", "_viscous",
        "coulomb", "current", "heat", "mean_current", "stage", "supply_current",
    )  # fmt: skip

    def __init__(
        self,
        motor: MotorSpec,
        gear: GearSpec,
        chopper: Averaged | Switched,
        dt: float,
        inertia: float | None = None,
    ) -> None:
        """Starts at rest without current; dt: tick, s.

        inertia: kg m² that the wheel has to move (its spin, the rotor and its share of the robot), by which a
        change of current tells the speed within the tick; a guess will do. None: the last tick's acceleration
        is taken to go on.
        """
        self.stage = stage_of(chopper, motor, dt)
        self._ratio = gear.ratio
        self._driving_loss = 1.0 - gear.efficiency
        self._driven_gain = 1.0 / gear.back_efficiency - 1.0
        self._emf = motor.back_emf * gear.ratio
        self._torque_constant = motor.torque_constant
        self._viscous = motor.viscous * gear.ratio
        per_ampere = gear.ratio * gear.efficiency * motor.torque_constant
        self._pull = self._emf * per_ampere * dt / inertia if inertia else 0.0
        self.coulomb = motor.coulomb * gear.ratio
        self.current = self.mean_current = self.supply_current = self.heat = 0.0
        self._last = 0.0

    def step(self, duty: float, enabled: bool, supply: float, wheel_speed: float) -> float:
        """Runs one tick and returns the torque at the wheel (N m, mean over the tick).

        duty −1 … 1; enabled: False opens the bridge; supply V; wheel_speed rad/s at the tick's start. The
        back-EMF runs through the tick as a straight line whose slope is that of the last tick, mended by what
        the change of current adds: the error is of second order in the tick.
        L di/dt = a U − R i − K_e N w, J dw/dt = η N K_t i − b w − … as in Slimane et al. 2014.
        """
        rise = wheel_speed - self._last
        self._last = wheel_speed
        current, emf, ramp = self.current, self._emf * wheel_speed, self._emf * rise
        if enabled:
            tick = self.stage.drive(current, duty, supply, emf + 0.5 * ramp, ramp)
            mended = self._pull * (tick[1] - self.mean_current)
            if not -GUESS < mended < GUESS:
                ramp += mended
                tick = self.stage.drive(current, duty, supply, emf + 0.5 * ramp, ramp)
        else:
            tick = self.stage.coast(current, supply, emf + 0.5 * ramp)
        self.current, mean, self.supply_current, self.heat = tick
        self.mean_current = mean
        shaft = self._torque_constant * mean - self._viscous * (wheel_speed + 0.5 * rise)
        along = wheel_speed if shaft > 0.0 else -wheel_speed
        return self._ratio * shaft * transmitted(self._driving_loss, self._driven_gain, along)
