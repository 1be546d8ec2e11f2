from __future__ import annotations

from math import pi, radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.types import ScenarioError
from hilbed.vision.lens import Lens


@given(st.integers(16, 4096), st.integers(16, 4096), st.floats(0.01, 3.1), st.floats(-0.49, 0.49))
def test_column_and_azimuth_are_inverse(width: int, height: int, fov: float, fraction: float) -> None:
    lens = Lens(width, height, fov)
    azimuth = fraction * fov
    assert lens.azimuth(lens.column(azimuth)) == pytest.approx(azimuth, abs=1e-9)


def test_the_outer_edges_of_the_outer_pixels_span_the_field_of_view() -> None:
    lens = Lens(640, 64, pi / 2)
    assert lens.azimuth(-0.5) == pytest.approx(pi / 4)
    assert lens.azimuth(639.5) == pytest.approx(-pi / 4)
    assert lens.azimuth(319.5) == 0.0


@pytest.mark.parametrize(
    ("width", "height", "degrees", "word"),
    [
        (0, 64, 90, "width"),
        (640, 100_000, 90, "height"),
        (640, 64, 180, "field of view"),
        (640, 64, 0, "field"),
    ],
)
def test_a_lens_that_cannot_be_is_refused(width: int, height: int, degrees: float, word: str) -> None:
    with pytest.raises(ScenarioError, match=word):
        Lens(width, height, radians(degrees))
