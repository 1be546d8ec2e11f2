"""A scenario's camera without its robot: labelled shots from wherever it is put."""

from __future__ import annotations

from collections.abc import Iterator
from types import TracebackType
from typing import Self

from hilbed.clock import nanos
from hilbed.cost import Cost
from hilbed.plant import KinematicSpec, RecordedSpec, SimulatedSpec
from hilbed.problems import nearest
from hilbed.scenario.load import Loaded
from hilbed.scene import BeaconSpec
from hilbed.sensors import CameraSpec
from hilbed.sensors.exposure import Exposure, still
from hilbed.sensors.eye import Setting
from hilbed.types import Pose, ScenarioError
from hilbed.vision.judging import VisionSpec
from hilbed.vision.lens import Lens
from hilbed.vision_kit.labelled import LabelledShot
from hilbed.vision_kit.poses import AlongPath, Anywhere, Poses


class Subject:
    """What a scenario gives to look with and at: its camera, beacons, and block `vision`.

    Raises ScenarioError where it has no camera, or more than one and does not say which.
    """

    def __init__(self, loaded: Loaded) -> None:
        self.name, self.scenario = loaded.name, loaded.scenario
        self.vision = loaded.scenario.vision or VisionSpec()
        self.camera_name, self.camera = _camera(loaded)
        plant = _simulated(loaded)
        self.beacons, self.scenery = tuple(plant.beacons), plant.scenery

    @property
    def lens(self) -> Lens:
        return self.camera.lens


def _camera(loaded: Loaded) -> tuple[str, CameraSpec]:
    sensors = loaded.scenario.sensors
    cameras = {name: spec for name, spec in sensors.items() if isinstance(spec, CameraSpec)}
    wanted = loaded.scenario.vision.camera if loaded.scenario.vision else None
    if wanted is None and len(cameras) == 1:
        return next(iter(cameras.items()))
    if not cameras:
        raise ScenarioError(f"{loaded.name}: there is no camera among its sensors")
    if wanted is None:
        raise ScenarioError(f"{loaded.name}: which camera? --set vision.camera={next(iter(cameras))}")
    if wanted not in cameras:
        raise ScenarioError(f"vision.camera: there is no camera {wanted!r}{nearest(wanted, list(cameras))}")
    return wanted, cameras[wanted]


def _simulated(loaded: Loaded) -> SimulatedSpec | KinematicSpec:
    plant = loaded.scenario.plant
    if isinstance(plant, RecordedSpec):
        raise ScenarioError(f"{loaded.name}: its robot is a recording, of which there are no frames")
    return plant


def make_poses(subject: Subject) -> Poses:
    """Returns where the frames are taken; raises ScenarioError where the path asked for is none."""
    scenario, vision = subject.scenario, subject.vision
    kind = vision.poses or ("random" if scenario.reference is None else "path")
    if kind == "random":
        return Anywhere(scenario.seed, subject.beacons, subject.camera, vision.distance)
    if scenario.reference is None:
        raise ScenarioError("vision.poses: path needs a reference, and there is none; random needs none")
    step = nanos(scenario.duration) // vision.frames
    return AlongPath(scenario.reference.build(), subject.beacons, subject.camera, step)


class Studio:
    """Renders a subject's frames with their truth; frame k is the same whichever came before.

    Raises ScenarioError where the renderer does not work. Gives the renderer back at the end of a `with`.
    """

    def __init__(self, subject: Subject) -> None:
        from hilbed.sensors.imager import open_imager

        self._subject, self._poses = subject, make_poses(subject)
        setting = Setting(subject.beacons, subject.scenery, subject.scenario.seed, subject.camera_name)
        self._imager = open_imager(subject.camera, setting, Cost())

    @property
    def lens(self) -> Lens:
        return self._subject.lens

    @property
    def beacons(self) -> tuple[BeaconSpec, ...]:
        return self._subject.beacons

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._imager.close()

    def __len__(self) -> int:
        return self._subject.vision.frames

    def __iter__(self) -> Iterator[LabelledShot]:
        return self.shots(len(self))

    def at(self, x: float, y: float, yaw: float, pan: float = 0.0) -> LabelledShot:
        """Returns the frame from where the robot stands still at x, y (m) and yaw, pan (rad)."""
        return self.shoot(still(0, Pose(x, y, yaw), pan))

    def take(self, k: int) -> LabelledShot:
        """Returns frame k."""
        return self.shoot(self._poses.at(k))

    def shots(self, count: int, first: int = 0) -> Iterator[LabelledShot]:
        """Yields the frames from `first` up to and without `count`."""
        for k in range(first, count):
            yield self.take(k)

    def shoot(self, exposure: Exposure) -> LabelledShot:
        """Returns the frame from wherever the camera is put."""
        shot = self._imager.shoot(exposure)
        return LabelledShot(shot, self._imager.truth(exposure, self._subject.beacons))
