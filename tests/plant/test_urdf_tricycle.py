"""The tricycle's URDF: instantiated for a geometry, and refused with a reason."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from hilbed.plant.urdf import Behind, moved_inertia
from hilbed.plant.urdf_tricycle import tricycle
from hilbed.resources import package_file
from hilbed.types import ScenarioError

FILE = package_file("urdf/tricycle.urdf")


def origin(robot: ElementTree.Element, joint: str) -> list[float]:
    found = robot.find(f"joint[@name='{joint}']/origin")
    assert found is not None
    return [float(word) for word in found.get("xyz", "").split()]


def inertia(robot: ElementTree.Element, link: str) -> dict[str, float]:
    found = robot.find(f"link[@name='{link}']/inertial/inertia")
    assert found is not None
    return {axis: float(value) for axis, value in found.attrib.items()}


def test_geometry_replaces_that_of_the_file() -> None:
    robot = ElementTree.fromstring(tricycle(FILE, 0.08, 0.5, 0.7, "front").text)
    assert origin(robot, "steering_joint") == [0.7, 0.0, 0.08]
    assert origin(robot, "front_wheel_joint") == [0.0, 0.0, 0.0]
    assert origin(robot, "left_wheel_joint") == [0.0, 0.25, 0.08]
    assert origin(robot, "right_wheel_joint") == [0.0, -0.25, 0.08]
    radii = [float(sphere.get("radius", "")) for sphere in robot.iter("sphere")]
    assert radii == [0.08] * 3  # and nothing else touches the ground


def test_the_body_is_stretched_with_it() -> None:
    """A box of 0.9 × 0.44 × 0.2 m and 20 kg becomes one of 0.45 × 0.88 × 0.2 m."""
    robot = ElementTree.fromstring(tricycle(FILE, 0.1, 1.2, 0.5, "rear").text)
    found, (a, b, c) = inertia(robot, "base_link"), (0.45, 0.88, 0.2)
    expected = [20 / 12 * (p * p + q * q) for p, q in ((b, c), (a, c), (a, b))]
    assert [found[axis] for axis in ("ixx", "iyy", "izz")] == pytest.approx(expected, rel=1e-3)
    at = robot.find("link[@name='base_link']/inertial/origin")
    assert at is not None
    assert [float(x) for x in at.get("xyz", "").split()] == pytest.approx([0.19, 0.0, 0.14])


def test_the_files_own_geometry_is_kept() -> None:
    own = ElementTree.parse(FILE).getroot()
    same = ElementTree.fromstring(tricycle(FILE, 0.1, 0.6, 1.0, "front").text)
    for link in ("base_link", "left_wheel_link", "fork_link", "front_wheel_link"):
        assert inertia(same, link) == pytest.approx(inertia(own, link))
    for joint in ("left_wheel_joint", "right_wheel_joint", "steering_joint"):
        assert origin(same, joint) == pytest.approx(origin(own, joint))


def test_which_wheels_are_driven() -> None:
    front, rear = (tricycle(FILE, 0.1, 0.6, 1.0, driven) for driven in ("front", "rear"))
    assert front.joints == ("front_wheel_joint", "steering_joint")
    assert rear.joints == ("left_wheel_joint", "right_wheel_joint", "steering_joint")
    assert sorted(front.treads) == sorted(rear.treads)
    assert front.treads[0] == "front_wheel_joint"
    assert front.mass == pytest.approx(24.0)
    # A disc's spin, and what the steering axis turns: fork and wheel about the vertical.
    assert front.spin == pytest.approx(0.5 * 0.8 * 0.1**2)
    assert front.steered == pytest.approx(0.0024 + 0.002167)
    behind = Behind(0.01, 0.03)
    assert moved_inertia(front, behind) == pytest.approx([0.004 + 0.01 + 24 * 0.01, 0.004567 + 0.03])
    assert moved_inertia(rear, behind) == pytest.approx([0.004 + 0.01 + 12 * 0.01] * 2 + [0.034567])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("steering_joint", "fork_joint", "no joint steering_joint; it has: .*fork_joint"),
        ('<origin xyz="1.0 0 0.1"/>', '<origin xyz="0 0 0.1"/>', "joint steering_joint lies neither"),
        ('<origin xyz="0 0.3 0.1"/>', '<origin xyz="0 far 0.1"/>', "joint left_wheel_joint lies neither"),
        ('<inertia ixx="0.3893"', '<other ixx="0.3893"', "base_link has no <inertial>"),
        ('<inertia ixx="0.007253"', '<other ixx="0.007253"', "fork_link has no <inertial>"),
        ('<origin xyz="0.38 0 0.14"/>', '<origin xyz="0.38"/>', "base_link's <inertial> has no place"),
    ],
)
def test_unfit_urdf_is_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    text = FILE.read_text()
    assert old in text
    (tmp_path / "robot.urdf").write_text(text.replace(old, new))
    with pytest.raises(ScenarioError, match=message):
        tricycle(tmp_path / "robot.urdf", 0.1, 0.6, 1.0, "front")
