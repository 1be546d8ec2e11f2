from __future__ import annotations

from math import pi

import pytest

from hilbed.vision.truth import SPURIOUS, match, sights
from tests.vision.scenes import beacon


def test_sights_are_relative_to_the_heading_and_wrapped() -> None:
    (sight,) = sights([beacon(pi - 0.1, 2.0)], 0.0, 0.0, -pi + 0.1)
    assert sight.azimuth == pytest.approx(-0.2)
    assert sight.distance == pytest.approx(2.0)


def test_match_is_the_beacon_pointed_at_the_nearer_of_two_in_line_or_none() -> None:
    seen = sights([beacon(0.5, 6.0), beacon(0.5, 3.0), beacon(-0.5, 3.0)], 0.0, 0.0, 0.0)
    assert match(0.501, seen) == 1
    assert match(-0.5 + 2 * pi, seen) == 2
    assert match(0.0, seen) == SPURIOUS
    assert match(0.0, []) == SPURIOUS
