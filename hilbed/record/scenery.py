"""What the MCAP log shows around the numbers: beacons, path, robot, images, events, in Foxglove's types.

Imports foxglove: only `mcap` imports this module, and only when a log is written.
"""

from __future__ import annotations

from collections.abc import Sequence

from foxglove import messages as fox

from hilbed.clock import SECOND
from hilbed.scene import COLOURS, BeaconSpec
from hilbed.types import Nanos, Snapshot

_GREY = fox.Color(r=0.45, g=0.5, b=0.55, a=1.0)
_GREEN = fox.Color(r=0.2, g=0.9, b=0.3, a=1.0)
_BLACK = fox.Color(r=0.0, g=0.0, b=0.0, a=0.6)


def stamp(t: Nanos) -> fox.Timestamp:
    """Returns Foxglove's form of a time that is not negative."""
    return fox.Timestamp(t // SECOND, t % SECOND)


def scene(
    t: Nanos, beacons: Sequence[BeaconSpec], path: Sequence[tuple[float, float]], radius: float
) -> fox.SceneUpdate:
    """Returns everything that stands still, and the robot as a disc of `radius` (m) on its frame."""
    entities = [
        fox.SceneEntity(timestamp=stamp(t), frame_id="map", id=f"beacon {k}", cylinders=[_cone(beacon)])
        for k, beacon in enumerate(beacons)
    ]
    points = [fox.Point3(x=x, y=y, z=0.002) for x, y in path]
    line = fox.LinePrimitive(thickness=0.01, points=points, color=_GREY)
    entities.append(fox.SceneEntity(timestamp=stamp(t), frame_id="map", id="reference", lines=[line]))
    body = fox.CylinderPrimitive(
        pose=_upright(0.0, 0.0, 0.08),
        size=fox.Vector3(x=2 * radius, y=2 * radius, z=0.1),
        bottom_scale=1.0, top_scale=0.9, color=_GREY,
    )  # fmt: skip
    entities.append(
        fox.SceneEntity(
            timestamp=stamp(t), frame_id="base_link", id="robot", frame_locked=True, cylinders=[body]
        )
    )
    return fox.SceneUpdate(entities=entities)


def _cone(beacon: BeaconSpec) -> fox.CylinderPrimitive:
    red, green, blue = COLOURS[beacon.colour]
    width = 2 * beacon.foot_radius
    return fox.CylinderPrimitive(
        pose=_upright(*beacon.at, beacon.height / 2),
        size=fox.Vector3(x=width, y=width, z=beacon.height),
        bottom_scale=1.0,
        top_scale=beacon.upper_radius / beacon.foot_radius,
        color=fox.Color(r=red, g=green, b=blue, a=1.0),
    )


def _upright(x: float, y: float, z: float) -> fox.Pose:
    return fox.Pose(
        position=fox.Vector3(x=x, y=y, z=z), orientation=fox.Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)
    )


def image(t: Nanos, snapshot: Snapshot) -> fox.RawImage:
    """Returns the frame as it is; the log's compression shrinks it, in a tenth of PNG's time."""
    height, width, _ = snapshot.image.shape
    return fox.RawImage(
        timestamp=stamp(t),
        frame_id="camera_optical",
        width=width,
        height=height,
        encoding="rgb8",
        step=3 * width,
        data=snapshot.image.tobytes(),
    )


def detections(t: Nanos, snapshot: Snapshot) -> fox.ImageAnnotations:
    """Returns a line at the column of every detection, with the beacon's index where it is known."""
    height = float(snapshot.image.shape[0])
    lines = [
        fox.PointsAnnotation(
            timestamp=stamp(t),
            type=fox.PointsAnnotationType.LineStrip,
            points=[fox.Point2(x=column, y=0.0), fox.Point2(x=column, y=height)],
            outline_color=_GREEN,
            thickness=1.0,
        )
        for column in snapshot.pixels
    ]
    labels = [
        fox.TextAnnotation(
            timestamp=stamp(t),
            position=fox.Point2(x=column + 2.0, y=10.0),
            text=str(beacon),
            font_size=10.0,
            text_color=_GREEN,
            background_color=_BLACK,
        )
        for column, beacon in zip(snapshot.pixels, snapshot.beacons, strict=True)
        if beacon is not None
    ]
    return fox.ImageAnnotations(timestamp=stamp(t), points=lines, texts=labels)


def event(t: Nanos, message: str) -> fox.Log:
    """Returns a line for the log panel."""
    return fox.Log(timestamp=stamp(t), level=fox.LogLevel.Info, message=message, name="hilbed")
