"""What a detector gives back, judged for a lens with tilt and distortion too."""

from __future__ import annotations

from math import nan, pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.vision.lens import Lens
from hilbed.vision.returned import checked, plain
from hilbed.vision.seams import Detection
from tests.vision.scenes import WIDE

ANYTHING = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=6) | st.dictionaries(st.text(max_size=7), inner, max_size=6),
    max_leaves=20,
)


@given(ANYTHING)
def test_whatever_comes_back_is_a_list_of_sound_detections_or_a_value_error(returned: object) -> None:
    try:
        found = checked(plain(returned), WIDE, 3)
    except ValueError:
        return
    low, high = WIDE.span
    for one in found:
        assert low - one.std <= one.azimuth <= high + one.std
        assert 0.0 < one.std <= pi
        assert -0.5 <= one.column <= 639.5
        assert one.beacon is None or 0 <= one.beacon < 3


def test_every_direction_that_a_pixel_looks_in_is_in_the_image() -> None:
    lens = Lens(320, 240, 200.0, 200.0, 159.5, 119.5, k1=-0.1, tilt=0.5)
    for column, row in ((0, 0), (319, 0), (0, 239), (319, 239), (160, 120)):
        azimuth, _ = lens.direction(float(column), float(row))
        rows = plain([(float(azimuth), 1e-3, column, None, row)])
        assert checked(rows, lens, 0) == [Detection(float(azimuth), 1e-3, column, None, row)]
    with pytest.raises(ValueError, match="out of the image"):
        checked(plain([(lens.span[1] + 0.01, 1e-3, 0.0)]), lens, 0)


def test_a_row_that_is_not_stated_is_nan() -> None:
    (found,) = checked(plain([(0.0, 1e-3, 320.0)]), WIDE, 0)
    assert repr(found) == repr(Detection(0.0, 1e-3, 320.0, None, nan))
