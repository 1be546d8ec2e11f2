"""Sensors that need no picture: what they would read is known from the pose, and noise is added to it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import nan
from typing import Annotated, NamedTuple, TypeAlias

from pydantic import Field

from hilbed.angles import wrap
from hilbed.effects import Effects
from hilbed.ports import Witness
from hilbed.sensors.delivery import Delivery, DeliverySpec
from hilbed.sensors.dropouts import Dropouts
from hilbed.spec import NonNegative
from hilbed.tally import counts_of
from hilbed.types import Nanos, Pose, Reading, Rng, Truth
from hilbed.vision.truth import SPURIOUS

LEAST = 1e-6
"""m or rad; a sensor without noise claims this standard deviation, so that nobody divides by zero."""

ANGLES = {"azimuth": (0,), "pose": (2,)}
"""Which components of a kind of reading are angles."""


class DirectSpec(DeliverySpec):
    """What all of these have besides rate, latency and loss.

    dropouts: how often a second, on the average, the sensor loses what it measures; dropout_length: s, mean
    (both times are exponential).
    """

    dropouts: Annotated[NonNegative, Field(le=1000)] = 0.0
    dropout_length: Annotated[float, Field(ge=0.001, le=1000)] = 0.5


class Post(NamedTuple):
    """What a sensor is given: name in the scenario, noise, what disturbs it, who hears the truth, seed."""

    name: str
    rng: Rng
    effects: Effects
    witness: Witness
    seed: int = 0


class Quantity(NamedTuple):
    """One thing to be read: kind, true value, standard deviation of its noise (a number a component).

    beacon: the one that it belongs to, SPURIOUS for none; claimed: the one that the reading names.
    """

    kind: str
    true: tuple[float, ...]
    std: tuple[float, ...]
    beacon: int = SPURIOUS
    claimed: int | None = None


Look: TypeAlias = Callable[[Pose], Sequence[Quantity]]
"""What there is to be read from a pose of the robot."""


class Direct:
    """Reads quantities at its rate, delivers after its latency, tells the witness the truth.

    A sensor that `effects` calls lost delivers nothing; one that they call broken delivers NaN.
    """

    def __init__(self, spec: DirectSpec, look: Look, post: Post) -> None:
        self._look = look
        self._post = post
        self._delivery = Delivery(spec, post.rng)
        self._dropouts = Dropouts(spec.dropouts, spec.dropout_length, post.rng)

    @property
    def due(self) -> Nanos:
        """When the next sample is to be taken."""
        return self._delivery.due

    def sample(self, truth: Truth) -> None:
        """Reads everything at truth.t and sends it on its way."""
        name, _, effects, witness, _ = self._post
        delivered = self._delivery.expose(truth.t)
        if self._dropouts.out(truth.t) or name in effects.lost:
            return
        quantities = self._look(truth.pose)
        readings = [self._reading(truth.t, delivered, quantity) for quantity in quantities]
        if self._delivery.put(readings):
            for reading, quantity in zip(readings, quantities, strict=True):
                witness.reading(reading, quantity.beacon, quantity.true)

    def read(self, t: Nanos) -> list[Reading]:
        """Returns the readings delivered up to and including t since the last call, oldest first."""
        return self._delivery.read(t)

    def counts(self) -> dict[str, float]:
        """Returns what could not be read, and why."""
        return counts_of(self._look)

    def flush(self) -> None:
        """Has nothing under way that the witness has not been told."""

    def close(self) -> None:
        """Holds nothing."""

    def _reading(self, t: Nanos, delivered: Nanos, quantity: Quantity) -> Reading:
        kind, true, stds, _, claimed = quantity
        noise = self._post.rng.standard_normal(len(true)).tolist()
        value = tuple(v + std * n for v, std, n in zip(true, stds, noise, strict=True))
        value = tuple(wrap(v) if k in ANGLES.get(kind, ()) else v for k, v in enumerate(value))
        if kind == "range":
            value = (max(value[0], 0.0),)
        if self._post.name in self._post.effects.broken:
            value = (nan,) * len(value)
        return Reading(kind, t, delivered, value, tuple(max(std, LEAST) for std in stds), claimed)
