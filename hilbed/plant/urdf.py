"""The robot's body: a URDF read, checked, and instantiated for the geometry that a scenario states."""

from __future__ import annotations

from math import inf
from pathlib import Path
from typing import Literal, NamedTuple
from xml.etree import ElementTree

from hilbed.types import ScenarioError

Element = ElementTree.Element


class Behind(NamedTuple):
    """What turns behind a gear (kg m²), rotor and gear: with each wheel, and with a steering axis."""

    wheel: float
    steering: float = 0.0


class Body(NamedTuple):
    """A robot ready for the physics.

    text: URDF without visuals; joints: names of joints in the order of the drives, that of a steering axis
    last; radius and track m; mass kg, of all of it; spin kg m², of one wheel about its axle; idle: joints of
    wheels that nobody drives; wheelbase m and steered kg m² (what a steering axis turns), 0 without one.
    """

    text: str
    joints: tuple[str, ...]
    radius: float
    track: float
    mass: float
    spin: float
    idle: tuple[str, ...] = ()
    wheelbase: float = 0.0
    steered: float = 0.0

    @property
    def driven(self) -> tuple[str, ...]:
        """Joints of the wheels that have a drive."""
        return self.joints[:-1] if self.steered else self.joints

    @property
    def treads(self) -> tuple[str, ...]:
        """Joints of all wheels on the ground, those with a drive first."""
        return (*self.driven, *self.idle)


def moved_inertia(body: Body, reflected: Behind) -> list[float]:
    """Returns what each drive has to turn as the robot goes straight on (kg m²), with the robot's mass."""
    wheel = body.spin + reflected.wheel + body.mass * body.radius**2 / len(body.driven)
    steering = [body.steered + reflected.steering] if body.steered else []
    return [wheel] * len(body.driven) + steering


def read_urdf(path: Path) -> Element:
    """Reads a URDF; raises ScenarioError with the line where it is no XML."""
    try:
        root = ElementTree.parse(path).getroot()
    except OSError as error:
        raise ScenarioError(f"{path}: {error.strerror or error}") from None
    except ElementTree.ParseError as error:
        line, column = error.position
        raise ScenarioError(
            f"{path}:{line}: not XML: {error.msg.split(':')[0]}, column {column + 1}"
        ) from None
    if root.tag != "robot":
        raise ScenarioError(f"{path}: the outermost element is <{root.tag}>, a URDF has <robot>")
    _check_tree(path, root)
    return root


def _check_tree(path: Path, root: Element) -> None:
    """Sees to it that joints make one tree of the links: PyBullet does not survive anything else."""
    links = [str(link.get("name")) for link in root.iterfind("link")]
    children = [_end(path, joint, "child", links) for joint in root.iterfind("joint")]
    parents = [_end(path, joint, "parent", links) for joint in root.iterfind("joint")]
    for names, what in ((links, "links are called"), (children, "joints lead to")):
        if twice := sorted({name for name in names if names.count(name) > 1}):
            raise ScenarioError(f"{path}: two {what} {twice[0]}")
    roots = [link for link in links if link not in children]
    if len(roots) != 1:
        raise ScenarioError(f"{path}: one link has to carry all the others; no joint leads to: {roots}")
    for link in roots:  # grows while it is walked
        roots += [child for parent, child in zip(parents, children, strict=True) if parent == link]
    if ring := sorted(set(links) - set(roots)):
        raise ScenarioError(f"{path}: the joints go round in a ring: {', '.join(ring)}")


def _end(path: Path, joint: Element, end: str, links: list[str]) -> str:
    element = joint.find(end)
    link = "" if element is None else element.get("link", "")
    if link not in links:
        raise ScenarioError(f"{path}: joint {joint.get('name')} has no {end} link")
    return link


def meshes(path: Path, part: Literal["collision", "visual"]) -> list[str]:
    """Returns the mesh files that links collide with or are drawn as, as the URDF names them."""
    found = read_urdf(path).iterfind(f"link/{part}/geometry/mesh")
    return [mesh.get("filename", "") for mesh in found]


def diffdrive(path: Path, radius: float, track: float) -> Body:
    """Instantiates the two-wheel robot of a URDF with another wheel radius and track (m).

    base_link lies on the ground below the midpoint of the axle. Wheels move to ±track/2 and to the height of
    their radius, their treads and inertia scale with it. Raises ScenarioError.
    """
    root = read_urdf(path)
    joints = ("left_wheel_joint", "right_wheel_joint")
    for name, side in zip(joints, (0.5, -0.5), strict=True):
        joint, wheel = turning(path, root, name, joints)
        joint.find("origin").set("xyz", f"0 {side * track!r} {radius!r}")  # type: ignore[union-attr]
        spin = scale_wheel(path, wheel, radius)
    text, mass = bare(path, root)
    return Body(text, joints, radius, track, mass, spin)


def bare(path: Path, root: Element) -> tuple[str, float]:
    """Returns the URDF without what physics has no use for, and the mass (kg) of all of it."""
    _drop_frames(root)
    for link in root.iterfind("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
    for mesh in root.iter("mesh"):  # PyBullet gets the text in another place
        mesh.set("filename", str((path.parent / mesh.get("filename", "")).resolve()))
    mass = sum(number(path, mass, "value") for mass in root.iter("mass"))
    return ElementTree.tostring(root, encoding="unicode"), mass


def turning(path: Path, root: Element, name: str, wanted: tuple[str, ...]) -> tuple[Element, Element]:
    """Returns a wheel's joint and link, complete enough to be scaled."""
    joints = {joint.get("name"): joint for joint in root.iter("joint")}
    if missing := [joint for joint in wanted if joint not in joints]:
        found = ", ".join(sorted(str(joint) for joint in joints)) or "none"
        raise ScenarioError(f"{path}: no joint {' and no joint '.join(missing)}; it has: {found}")
    joint = joints[name]
    if joint.get("type") != "continuous":
        raise ScenarioError(f"{path}: joint {name} is {joint.get('type')}, a wheel's is continuous")
    if joint.find("origin") is None:
        raise ScenarioError(f"{path}: joint {name} has no <origin>")
    child = joint.find("child")
    link = None if child is None else root.find(f"link[@name='{child.get('link')}']")
    if link is None:
        raise ScenarioError(f"{path}: joint {name} has no child link")
    return joint, link


def scale_wheel(path: Path, wheel: Element, radius: float) -> float:
    """Takes a wheel to another radius, inertia with its square at equal mass; returns that of its spin."""
    tread = wheel.find("collision/geometry/sphere")
    if tread is None:
        shape = wheel.find("collision/geometry/*")
        was = "nothing" if shape is None else f"<{shape.tag}>"
        raise ScenarioError(f"{path}: {wheel.get('name')} collides as {was}; wheels roll as a <sphere>")
    inertia = wheel.find("inertial/inertia")
    if inertia is None:
        raise ScenarioError(f"{path}: {wheel.get('name')} has no <inertial> with mass and inertia")
    factor = radius / number(path, tread, "radius")
    tread.set("radius", repr(radius))
    for axis in ("ixx", "iyy", "izz"):
        inertia.set(axis, repr(number(path, inertia, axis) * factor**2))
    return number(path, inertia, "iyy")


def number(path: Path, element: Element, key: str) -> float:
    """Returns an attribute that only makes sense as a positive number."""
    text = element.get(key, "nothing")
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0.0 < number < inf:
        raise ScenarioError(f"{path}: <{element.tag} {key}> is {text}, not a positive number")
    return number


def _drop_frames(root: Element) -> None:
    """Takes out links without inertia, from the tips inward: PyBullet would give each of them 1 kg."""
    while True:
        parents = {parent.get("link") for parent in root.iterfind("joint/parent")}
        tips = [
            link
            for link in root.iterfind("link")
            if link.find("inertial") is None and link.get("name") not in parents
        ]
        joints = [joint for joint in root.iterfind("joint") if _leads_to(joint, tips)]
        if not joints:
            return
        for element in tips + joints:
            root.remove(element)


def _leads_to(joint: Element, links: list[Element]) -> bool:
    child = joint.find("child")
    return child is not None and child.get("link") in {link.get("name") for link in links}
