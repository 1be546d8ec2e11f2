"""Where frames are taken, and what refuses to be filmed."""

from __future__ import annotations

from math import hypot, pi

import numpy as np
import pytest

from hilbed.types import ScenarioError
from hilbed.vision_kit.poses import CLEARANCE
from hilbed.vision_kit.studio import Studio, Subject, make_poses
from tests.vision_kit.scenes import small


def test_random_poses_look_at_a_beacon_from_the_distances_asked_for() -> None:
    subject = Subject(
        small("vision.poses=random", "vision.distance=[2, 6]", "sensors.camera.mount=[0.3, 0.1, 0.3]")
    )
    poses = make_poses(subject)
    seen = set()
    with Studio(subject) as studio:
        for k in range(12):
            view = studio.take(k).truth
            near = [one for one in view.beacons if 2 <= one.distance <= 6 and abs(one.azimuth) <= pi / 4]
            assert near, "one beacon at least, before the camera"
            assert all(one.distance > CLEARANCE - 0.32 for one in view.beacons)
            seen |= {one.beacon for one in near}
            assert poses.at(k) == make_poses(subject).at(k), "by its number alone"
    assert len(seen) > 6


def test_poses_along_the_path_are_those_of_the_reference() -> None:
    loaded = small(frames=10)
    subject = Subject(loaded)
    assert loaded.scenario.reference is not None
    reference = loaded.scenario.reference.build()
    poses = make_poses(subject)
    times = [poses.at(k).t for k in range(10)]
    assert np.diff(times).tolist() == [2_000_000_000] * 9, "spread over the 20 s of the scenario"
    for k in range(10):
        exposure = poses.at(k)
        assert [m.t - exposure.t for m in exposure.moments] == list(
            range(-100_000_000, 100_000_001, 20_000_000)
        )
        for moment in exposure.moments:
            assert moment.pose == reference.at(moment.t).pose
            assert moment.pan == pytest.approx(1.5e-9 * moment.t)


def test_a_long_exposure_is_told_of_whole() -> None:
    slow = ("sensors.camera.rate=1", "sensors.camera.exposure=0.7", "sensors.camera.latency=0.5")
    for poses in ("path", "random"):
        exposure = make_poses(Subject(small(*slow, f"vision.poses={poses}"))).at(1)
        assert exposure.moments[0].t <= exposure.t - 0.35e9
        assert exposure.moments[-1].t >= exposure.t + 0.35e9


def test_an_axis_that_tracks_a_beacon_looks_at_it() -> None:
    pan = "sensors.camera.pan={kind: tracking, beacon: 3, rate: 10}"
    with Studio(Subject(small(pan, frames=3))) as studio:
        for frame in studio:
            assert frame.truth.beacons[3].azimuth == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("poses", ["path", "random"])
def test_a_frame_is_the_same_whichever_came_before(poses: str) -> None:
    flaws = ("read_noise=0.05", "exposure=0.01", "latency=0.05")
    subject = Subject(small(f"vision.poses={poses}", *(f"sensors.camera.{flaw}" for flaw in flaws)))
    with Studio(subject) as studio:
        forward = [studio.take(k) for k in range(3)]
        backward = [studio.take(k) for k in (2, 1, 0)][::-1]
    for one, other in zip(forward, backward, strict=True):
        assert np.array_equal(one.shot.image, other.shot.image)
        assert repr(one.truth) == repr(other.truth)


def test_a_camera_among_others_is_named() -> None:
    second = "sensors.second={kind: camera, width: 32, height: 16}"
    with pytest.raises(ScenarioError, match=r"which camera\? --set vision.camera=camera"):
        Subject(small(second))
    assert Subject(small(second, "vision.camera=second")).lens.width == 32


def test_a_path_needs_a_reference() -> None:
    loaded = small("vision.poses=path")
    without = loaded._replace(scenario=loaded.scenario.model_copy(update={"reference": None}))
    with pytest.raises(ScenarioError, match="path needs a reference"):
        make_poses(Subject(without))


def test_beacons_all_over_each_other_still_give_frames() -> None:
    """No place is clear of all of them: the last one tried is taken."""
    at = [f"{{at: [{0.2 * x}, {0.2 * y}], colour: red}}" for x in range(12) for y in range(12)]
    crowd = (f"plant.beacons=[{', '.join(at)}]", "sensors.camera.identity=anonymous")
    subject = Subject(small(*crowd, "vision.poses=random", "vision.distance=[0.1, 0.3]"))
    assert hypot(*make_poses(subject).at(0).moments[0].pose[:2]) < 10
