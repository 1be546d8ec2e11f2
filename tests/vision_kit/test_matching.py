"""Which detection shows which beacon, against every way to pair them."""

from __future__ import annotations

from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed.vision.lens import Lens
from hilbed.vision.seams import BeaconTruth, Detection
from hilbed.vision_kit.matching import REACH, match, pixels

LENS = Lens.of_fov(640, 64, pi / 2)


def truth(beacon: int, column: float, half: int = 4, **more: float) -> BeaconTruth:
    azimuth = LENS.azimuth(column)
    box = (round(column) - half, 10, round(column) + half, 50)
    given = {"distance": 5.0, "visible": 1.0, **more}
    return BeaconTruth(beacon, azimuth, 0.0, azimuth, 0.0, box=box, column=column, row=30.0, **given)


def found(column: float, beacon: int | None = None, std: float = 1e-4) -> Detection:
    return Detection(LENS.azimuth(column), std, column, beacon)


def test_errors_are_of_the_right_beacon_in_rad_and_pixels() -> None:
    matched = match(
        (7, 0.5), [truth(0, 100), truth(1, 300), truth(2, 500)], [found(501.5, 2), found(99, 1)], LENS
    )
    by = {one.beacon: one for one in matched.sightings}
    assert [one.found for one in matched.sightings] == [True, False, True]
    assert by[0].error_px == pytest.approx(1.0, abs=0.01)
    assert by[2].error_px == pytest.approx(-1.5, abs=0.01)
    assert by[0].error > 0, "one column to the left is a larger azimuth, so the error is positive"
    assert (by[0].mistaken, by[2].mistaken) == (True, False)
    assert matched.strays == []
    assert {one.frame for one in matched.sightings} == {7}


def test_a_second_detection_of_one_beacon_is_a_stray() -> None:
    matched = match((0, 1.0), [truth(0, 100)], [found(103), found(100.2)], LENS)
    assert matched.sightings[0].error_px == pytest.approx(-0.2, abs=0.01)
    assert [stray.detection for stray in matched.strays] == [0]


@pytest.mark.parametrize(("off", "hit"), [(4.4 + REACH, True), (4.6 + REACH, False)])
def test_a_detection_belongs_to_a_beacon_up_to_its_rim_and_a_bit(off: float, hit: bool) -> None:
    matched = match((0, 1.0), [truth(0, 319.5)], [found(319.5 + off)], LENS)
    assert matched.sightings[0].found == hit
    assert len(matched.strays) == (not hit)


def test_a_beacon_that_is_not_seen_matches_nothing() -> None:
    hidden = truth(0, 100)._replace(box=None, visible=0.0)
    matched = match((0, 1.0), [hidden], [found(100)], LENS)
    assert matched.sightings == []
    assert matched.strays[0].distance != matched.strays[0].distance, "no beacon is near"


@pytest.mark.parametrize(
    ("left", "right", "cut"), [(0, 9, True), (1, 9, False), (630, 638, False), (631, 639, True)]
)
def test_a_side_cut_off_by_the_border_is_told(left: int, right: int, cut: bool) -> None:
    beacon = truth(0, (left + right) / 2)._replace(box=(left, 0, right, 63))
    assert match((0, 1.0), [beacon], [], LENS).sightings[0].cut == cut


@pytest.mark.parametrize(
    ("column", "distance", "cut"), [(109, 3.0, True), (110, 3.0, False), (105, 7.0, False)]
)
def test_a_side_that_a_nearer_beacon_hides_is_told(column: int, distance: float, cut: bool) -> None:
    other = truth(1, column, distance=distance)
    matched = match((0, 1.0), [truth(0, 100), other], [], LENS)
    assert matched.sightings[0].cut == cut


places = st.lists(st.integers(20, 620), max_size=4, unique=True)


@given(places, places)
def test_pairs_are_stable(beacons: list[int], detections: list[int]) -> None:
    """No detection and beacon within reach would both rather have each other than what they have."""
    columns = [column + 0.3 for column in detections]
    matched = match((0, 1.0), [truth(k, b) for k, b in enumerate(beacons)], [found(d) for d in columns], LENS)
    mine = {beacons[one.beacon]: abs(one.error_px) for one in matched.sightings if one.found}
    free = {columns[stray.detection] for stray in matched.strays}
    assert len(mine) + len(free) == len(detections)
    for beacon in beacons:
        for column in free:
            if abs(column - beacon) <= 4.5 + REACH - 0.1:
                assert mine.get(beacon, 1e9) <= abs(column - beacon) + 0.02, "px are of a curved image"


@pytest.mark.parametrize("lens", [LENS, Lens(640, 480, 400, 410, 300, 250, k1=-0.2, k2=0.05, tilt=0.1)])
@pytest.mark.parametrize("column", [40.0, 320.0, 600.0])
def test_pixels_are_columns(lens: Lens, column: float) -> None:
    """Against the lens itself: how far the pixel moves that shows the azimuth."""
    azimuth, elevation = (float(angle) for angle in lens.direction(column, 30.0))
    beacon = truth(0, 320)._replace(azimuth=azimuth, elevation=elevation)
    error = 1e-3
    there = float(lens.pixel(azimuth + error, elevation)[0])
    assert pixels(lens, beacon, error) == pytest.approx(column - there, rel=3e-3)
