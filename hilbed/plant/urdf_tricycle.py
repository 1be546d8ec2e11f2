"""The tricycle's URDF, instantiated for the geometry that a scenario states."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from hilbed.plant.urdf import Body, Element, bare, number, read_urdf, scale_wheel, turning
from hilbed.types import ScenarioError

REAR = ("left_wheel_joint", "right_wheel_joint")
FRONT = ("front_wheel_joint",)
STEERING = "steering_joint"


def tricycle(
    path: Path, radius: float, track: float, wheelbase: float, driven: Literal["front", "rear"]
) -> Body:
    """Instantiates the three-wheel robot of a URDF with another wheel radius, track and wheelbase (m).

    base_link lies on the ground below the midpoint of the rear axle; its masses are stretched with track and
    wheelbase. Wheels move to the height of their radius, their treads and inertia scale with it. The steering
    axis carries the front wheel and stands over its contact. Raises ScenarioError.
    """
    root = read_urdf(path)
    wanted = (*REAR, STEERING, *FRONT)
    found = {name: turning(path, root, name, wanted) for name in wanted}
    origin = {name: joint.find("origin") for name, (joint, _) in found.items()}
    was = [_place(path, origin[name], name) for name in (STEERING, REAR[0])]
    _stretch(path, root, wheelbase / was[0][0], track / (2.0 * was[1][1]))
    for name, place in (
        (REAR[0], f"0 {0.5 * track!r} {radius!r}"),
        (REAR[1], f"0 {-0.5 * track!r} {radius!r}"),
        (STEERING, f"{wheelbase!r} 0 {radius!r}"),
        (FRONT[0], "0 0 0"),
    ):
        origin[name].set("xyz", place)  # type: ignore[union-attr]
    spin, *_ = [scale_wheel(path, found[name][1], radius) for name in (*FRONT, *REAR)]
    steered = sum(_about_z(path, found[name][1]) for name in (STEERING, *FRONT))
    text, mass = bare(path, root)
    wheels, idle = (FRONT, REAR) if driven == "front" else (REAR, FRONT)
    return Body(text, (*wheels, STEERING), radius, track, mass, spin, idle, wheelbase, steered)


def _place(path: Path, origin: Element | None, name: str) -> tuple[float, float]:
    """Returns how far ahead and to the left a joint is, one of which must not be zero."""
    words = ("" if origin is None else origin.get("xyz", "")).split()
    try:
        x, y = float(words[0]), float(words[1])
    except (ValueError, IndexError):
        x = y = 0.0
    if not x > 0.0 and not y > 0.0:
        raise ScenarioError(f"{path}: joint {name} lies neither ahead of base_link nor to its left")
    return x, y


def _about_z(path: Path, link: Element) -> float:
    """Returns a link's inertia (kg m²) about the steering axis, which its centre of mass lies on."""
    inertia = link.find("inertial/inertia")
    if inertia is None:
        raise ScenarioError(f"{path}: {link.get('name')} has no <inertial> with mass and inertia")
    return number(path, inertia, "izz")


def _stretch(path: Path, root: Element, along: float, across: float) -> None:
    """Stretches base_link's masses: second moments grow with the square of the factor in their direction."""
    base = root.find("link[@name='base_link']/inertial")
    inertia = None if base is None else base.find("inertia")
    origin = None if base is None else base.find("origin")
    if inertia is None:
        raise ScenarioError(f"{path}: base_link has no <inertial> with mass and inertia")
    if origin is not None:
        try:
            x, y, z = (float(word) for word in origin.get("xyz", "0 0 0").split())
        except ValueError:
            raise ScenarioError(f"{path}: base_link's <inertial> has no place of three numbers") from None
        origin.set("xyz", f"{x * along!r} {y * across!r} {z!r}")
    xx, yy, zz = (number(path, inertia, axis) for axis in ("ixx", "iyy", "izz"))
    lengths = 0.5 * (yy + zz - xx) * along**2
    widths = 0.5 * (xx + zz - yy) * across**2
    heights = 0.5 * (xx + yy - zz)
    for axis, value in (("ixx", widths + heights), ("iyy", lengths + heights), ("izz", lengths + widths)):
        inertia.set(axis, repr(value))
