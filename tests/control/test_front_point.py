"""Front-point tracking beside its largest commands."""

from __future__ import annotations

import numpy as np

from hilbed.control.front_point import FrontPoint, FrontPointSpec
from hilbed.control.reference import CircleSpec
from hilbed.types import Estimate

CIRCLE = CircleSpec(kind="circle", speed=0.5).build()


def test_cycles_in_which_the_law_wants_more_than_it_may_are_counted() -> None:
    law = FrontPoint(FrontPointSpec(max_speed=1.0, max_turn_rate=4.0), CIRCLE)
    near = CIRCLE.at(0).pose
    law.step(0, Estimate(0, np.array(near), np.eye(3)))
    assert law.counts() == {"saturated": 0}
    v, w = law.step(0, Estimate(0, np.array([near.x - 3.0, near.y - 3.0, near.yaw]), np.eye(3)))
    assert (v, w) == (1.0, 4.0)
    assert law.counts() == {"saturated": 1}
