"""Motors as their data sheets give them."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field, model_validator

from hilbed.spec import NonNegative, Positive, Spec


class MotorSpec(Spec):
    """A brushed permanent-magnet DC motor; everything at its own shaft, before any gear.

    resistance Ω and inductance H of the winding at its terminals; back_emf V s/rad; torque_constant
    N m/A; rotor_inertia kg m²; coulomb N m and viscous N m s/rad: friction of brushes and bearings;
    nominal_current A, continuous; max_current A, for short times; source: where the numbers are from.
    In SI back_emf and torque_constant are one quantity, or energy is not conserved.
    """

    resistance: Positive
    inductance: Positive
    back_emf: Positive
    torque_constant: Positive
    rotor_inertia: Positive
    coulomb: NonNegative = 0.0
    viscous: NonNegative = 0.0
    nominal_current: Positive
    max_current: Positive
    source: str = Field(min_length=1)

    @model_validator(mode="after")
    def _conserves_energy(self) -> MotorSpec:
        if abs(self.back_emf / self.torque_constant - 1.0) > 0.02:
            raise ValueError(
                f"back_emf {self.back_emf:g} V s/rad and torque_constant {self.torque_constant:g} N m/A "
                "must be the same number within the 2 % that data sheets round"
            )
        return self


MOTORS = {
    "re35": MotorSpec(
        resistance=0.583,
        inductance=0.191e-3,
        # 29.2 mN m/A; the sheet's 328 rpm/V is the same number, rounded in another unit (29.11 mV s/rad).
        back_emf=29.2e-3,
        torque_constant=29.2e-3,
        rotor_inertia=79.2e-7,
        # No-load current 168 mA at 7670 rpm is 4.9 mN m. The sheet does not divide it: four fifths are
        # taken as Coulomb friction, which graphite brushes mostly are, the rest as viscous.
        coulomb=3.92e-3,
        viscous=1.22e-6,
        nominal_current=3.36,
        # Free: three times nominal for seconds; the sheet only gives the stall current, 41 A.
        max_current=10.0,
        source="maxon RE 35, graphite brushes, 90 W, 24 V winding, order number 323890, data sheet",
    ),
}


def _by_name(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    if value not in MOTORS:
        raise ValueError(
            f"no motor '{value}' in the catalogue; there are {', '.join(MOTORS)}, or give a block"
        )
    return MOTORS[value]


Motor = Annotated[MotorSpec, BeforeValidator(_by_name)]
