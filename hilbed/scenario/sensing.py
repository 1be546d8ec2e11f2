"""Checks of what is sensed: by what, of what, and whether the estimator can use it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from hilbed.control import ControllerSpec
from hilbed.disturbances import DisturbanceSpec
from hilbed.estimation import EstimatorSpec
from hilbed.plant import PlantSpec, RecordedSpec
from hilbed.problems import Problem, nearest
from hilbed.sensors import CameraSpec, PositionSpec, SensorSpec
from hilbed.sensors.camera import names
from hilbed.sensors.mounts import mounts
from hilbed.sensors.pan import make_pan
from hilbed.types import ScenarioError

Problems = Iterator[Problem]

FOOD = {
    "ekf": ("azimuth", "range"),
    "particles": ("position", "pose"),
    "attitude": ("position",),
    "measured": ("pose",),
    "bearing_lyapunov": ("azimuth",),
    "bearing_kalman": ("azimuth",),
    "bearing_luenberger": ("azimuth",),
    "bearing_survey": ("azimuth",),
}
"""The kinds of readings of which an estimator needs one at least."""

UPSETS = ("camera_loss", "spurious_azimuths", "sensor_loss", "sensor_nan")
"""Disturbances of sensors, which an ideal robot has as well."""


def pans(sensors: Mapping[str, SensorSpec], plant: PlantSpec) -> Problems:
    """A camera's axis follows what the camera can recognise."""
    for name, sensor in sensors.items():
        if isinstance(sensor, CameraSpec) and not isinstance(plant, RecordedSpec):
            try:
                make_pan(sensor.pan, names(sensor, plant.beacons))
            except ScenarioError as error:
                yield Problem(("sensors", name, "pan"), f"sensors.{name}.pan: {error}")


def one_mount(sensors: Mapping[str, SensorSpec], plant: PlantSpec, estimator: EstimatorSpec) -> Problems:
    """The filter knows one place for all sensors of landmarks."""
    if estimator.kind == "ekf" and not isinstance(plant, RecordedSpec):
        places = {place: name for name, place in mounts(sensors).items()}
        if len(places) > 1:
            text = f"sensors: {' and '.join(places.values())} have different mounts; ekf knows one for all"
            yield Problem(("sensors",), text)


def food(estimator: EstimatorSpec, sensors: Mapping[str, SensorSpec], plant: PlantSpec) -> Problems:
    """An estimator that corrects needs something to correct by."""
    wanted = FOOD.get(estimator.kind, ())
    if not wanted or isinstance(plant, RecordedSpec):
        return
    needs = f"estimator: {estimator.kind} needs readings"
    served = {kind: name for name, sensor in sensors.items() for kind in sensor.kinds()}
    if not sensors:
        text = f"{needs} and there are no sensors; add one, or use the kind odometry"
        yield Problem(("estimator",), text)
    elif not set(wanted) & set(served):
        given = "; ".join(f"{name} gives {kind}" for kind, name in served.items())
        yield Problem(("estimator",), f"{needs} of {' or '.join(wanted)}, but {given}")


def landmarks(sensors: Mapping[str, SensorSpec], plant: PlantSpec, estimator: EstimatorSpec) -> Problems:
    """An estimator that lives on landmarks has some to be seen."""
    if isinstance(plant, RecordedSpec) or plant.beacons or "azimuth" not in FOOD.get(estimator.kind, ()):
        return
    blind = [name for name, sensor in sensors.items() if not isinstance(sensor, PositionSpec)]
    if blind:
        text = f"plant.beacons: {blind[0]} sees nothing without beacons, and {estimator.kind} needs readings"
        yield Problem(("plant", "beacons"), text)


def markers(sensors: Mapping[str, SensorSpec], controller: ControllerSpec | None) -> Problems:
    """A marker ahead that the controller steers by is where the controller believes it."""
    if controller is None or controller.kind != "front_point":
        return
    for name, sensor in sensors.items():
        if isinstance(sensor, PositionSpec) and sensor.front not in (None, controller.ahead):
            told = f"the controller's point is {controller.ahead:g} m ahead"
            text = f"sensors.{name}.front: the marker is {sensor.front:g} m ahead of the axle, but {told}"
            yield Problem(("sensors", name, "front"), text)


def disturbed(disturbances: list[DisturbanceSpec], sensors: Mapping[str, SensorSpec]) -> Problems:
    """What disturbs a sensor names one that can be disturbed so."""
    for k, disturbance in enumerate(disturbances):
        place = f"disturbances.{k}"
        camera = any(sensor.kind == "camera" for sensor in sensors.values())
        if disturbance.kind in ("camera_loss", "spurious_azimuths") and not camera:
            text = f"{place}: {disturbance.kind} needs a camera among the sensors"
            yield Problem(("disturbances", k), text)
        name = getattr(disturbance, "sensor", None)
        if name is None:
            continue
        if name not in sensors:
            text = f"{place}.sensor: there is no sensor {name!r}{nearest(name, list(sensors))}"
            yield Problem(("disturbances", k, "sensor"), text)
        elif sensors[name].kind == "camera":
            text = f"{place}.sensor: {name} is a camera; camera_loss and spurious_azimuths are for those"
            yield Problem(("disturbances", k, "sensor"), text)


CHECKS = (pans, one_mount, food, landmarks, markers, disturbed)
