"""The robot's URDF: instantiated for a geometry, and refused with a reason."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from hilbed.plant.checks import MASS, SHARE, SPIN, WHEEL_SPIN
from hilbed.plant.urdf import Behind, diffdrive, moved_inertia
from hilbed.resources import package_file
from hilbed.types import ScenarioError

FILE = package_file("urdf/diffdrive.urdf")


def changed(folder: Path, *replacements: tuple[str, str]) -> Path:
    text = FILE.read_text()
    for old, new in replacements:
        assert old in text
        text = text.replace(old, new)
    (folder / "robot.urdf").write_text(text)
    return folder / "robot.urdf"


def test_geometry_replaces_that_of_the_file() -> None:
    body = diffdrive(FILE, 0.05, 0.3)
    robot = ElementTree.fromstring(body.text)
    for name, y in (("left_wheel", 0.15), ("right_wheel", -0.15)):
        origin = robot.find(f"joint[@name='{name}_joint']/origin")
        wheel = robot.find(f"link[@name='{name}_link']")
        assert origin is not None
        assert wheel is not None
        assert [float(v) for v in origin.get("xyz", "").split()] == [0.0, y, 0.05]
        sphere, inertia = wheel.find("collision/geometry/sphere"), wheel.find("inertial/inertia")
        assert sphere is not None
        assert inertia is not None
        assert float(sphere.get("radius", "")) == pytest.approx(0.05)
        # ½ m R²
        assert float(inertia.get("iyy", "")) == pytest.approx(0.5 * 0.5 * 0.05**2)


def test_what_a_wheel_has_to_move() -> None:
    body = diffdrive(FILE, 0.1, 0.4)
    assert body.mass == MASS
    assert body.spin == WHEEL_SPIN
    assert moved_inertia(body, Behind(SPIN - WHEEL_SPIN)) == pytest.approx([SHARE, SHARE])


def test_the_files_own_geometry_is_kept() -> None:
    own, wheel = ElementTree.parse(FILE), ".//link[@name='left_wheel_link']/inertial/inertia"
    same = ElementTree.fromstring(diffdrive(FILE, 0.1, 0.4).text)
    assert {k: float(v) for k, v in own.find(wheel).attrib.items()} == pytest.approx(  # type: ignore[union-attr]
        {k: float(v) for k, v in same.find(wheel).attrib.items()}  # type: ignore[union-attr]
    )


def test_frames_without_mass_stay_out_of_the_physics() -> None:
    robot = ElementTree.fromstring(diffdrive(FILE, 0.1, 0.4).text)
    links = [link.get("name") for link in robot.iter("link")]
    assert links == ["base_link", "left_wheel_link", "right_wheel_link"]
    assert len(robot.findall("joint")) == 2


@pytest.mark.parametrize(
    ("replacements", "message"),
    [
        (
            [("left_wheel_joint", "wheel_left_joint")],
            r"no joint left_wheel_joint; it has: camera_joint, .*, right_wheel_joint, wheel_left_joint",
        ),
        (
            [('<joint name="left_wheel_joint" type="continuous">', "<oops>")],
            r"robot\.urdf:\d+: not XML: mismatched tag",
        ),
        ([('<sphere radius="0.1"/>', '<box size="1 1 1"/>')], "left_wheel_link collides as <box>"),
        ([('type="continuous"', 'type="fixed"')], "joint left_wheel_joint is fixed"),
        (
            [('<sphere radius="0.1"/>', '<sphere radius="round"/>')],
            "<sphere radius> is round, not a positive",
        ),
        ([("<robot name", "<car name"), ("</robot>", "</car>")], "outermost element is <car>"),
        ([('<child link="left_wheel_link"/>', "")], "joint left_wheel_joint has no child link"),
        ([('<child link="camera_link"/>', '<child link="nothing"/>')], "has no child link"),
        (
            [('<child link="camera_link"/>', '<child link="left_wheel_link"/>')],
            "two joints lead to left_wheel",
        ),
        ([('<link name="camera_link"', '<link name="base_link"')], "has no child link"),
        ([('<link name="camera_link"', '<link name="base_link"/><link name="camera_link"')], "two links are"),
        ([('<link name="camera_link"', '<link name="loose"/><link name="camera_link"')], "no joint leads to"),
        ([('<child link="left_wheel_link"/>', '<child link="base_link"/>')], "round in a ring: base_link"),
        (
            [('<parent link="camera_pan_link"/>', '<parent link="camera_link_optical"/>')],
            "round in a ring: camera_link, camera_link_optical",
        ),
        ([('<origin xyz="0 0.2 0.1"/>', "")], "joint left_wheel_joint has no <origin>"),
        ([('<inertia ixx="0.001317"', '<other ixx="0.001317"')], "has no <inertial>"),
    ],
)
def test_unfit_urdf_is_refused(tmp_path: Path, replacements: list[tuple[str, str]], message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        diffdrive(changed(tmp_path, *replacements), 0.1, 0.4)


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"none\.urdf: No such file"):
        diffdrive(tmp_path / "none.urdf", 0.1, 0.4)
    with pytest.raises(ScenarioError, match=r"package:urdf/none\.urdf"):
        package_file("urdf/none.urdf")
