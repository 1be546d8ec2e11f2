"""All metrics by name: functions of the signals, and functions of the signals and one drive."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import NamedTuple

from hilbed.criteria.signals import Missing, Signals


class Metric(NamedTuple):
    """How a number is taken from the signals of a run: by the function of this name in a module beside.

    The module is imported when it is asked for: to know the names of the metrics takes no numpy.
    """

    module: str
    name: str
    unit: str

    @property
    def of(self) -> Callable[..., float]:
        """The function; its docstring is the metric's description."""
        function: Callable[..., float] = getattr(import_module(f"hilbed.criteria.{self.module}"), self.name)
        return function

    @property
    def about(self) -> str:
        """The first line of the function's docstring."""
        return (self.of.__doc__ or "").partition("\n")[0]


def _metrics(module: str, units: Mapping[str, str]) -> dict[str, Metric]:
    return {name: Metric(module, name, unit) for name, unit in units.items()}


_RUN_UNITS = {
    "pose": {
        "estimate_position_rms": "m",
        "estimate_position_max": "m",
        "estimate_position_final": "m",
        "estimate_yaw_rms": "rad",
        "estimate_yaw_final": "rad",
        "odometry_position_rms": "m",
        "odometry_position_final": "m",
        "odometry_yaw_rms": "rad",
        "odometry_over_estimate": "",
        "cross_track_rms": "m",
        "cross_track_max": "m",
        "reference_distance_rms": "m",
        "reference_distance_max": "m",
        "reference_distance_final": "m",
        "reference_yaw_rms": "rad",
        "reference_yaw_max": "rad",
        "reference_yaw_final": "rad",
        "turning_radius": "m",
        "landmark_distance_error_max": "m",
    },
    "consistency": {
        "nees_mean": "",
        "nees_position_mean": "",
        "nis_mean": "",
        "accepted_fraction": "",
        "azimuth_count": "",
        "azimuth_spurious": "",
        "azimuth_bias_mdeg": "mdeg",
        "azimuth_std_mdeg": "mdeg",
        "azimuth_rms_mdeg": "mdeg",
        "range_bias": "m",
        "range_std": "m",
        "position_count": "",
        "position_rms": "m",
    },
    "bus": {
        "bus_load": "",
        "bus_load_max": "",
        "bus_frames": "",
        "bus_latency_mean": "s",
        "bus_latency_max": "s",
        "bus_errors": "",
    },
    "realtime": {
        "missed_deadlines": "",
        "lateness_p99": "s",
        "lateness_max": "s",
    },
}
_DRIVE_UNITS = {
    "speed_rms_error": "rad/s",
    "load_dip": "rad/s",
    "load_recovery": "s",
    "duty_chatter": "",
    "step_overshoot": "",
    "angle_rms_error": "rad",
    "slip_max": "m/s",
    "current_max": "A",
    "duty_max": "",
}

RUN_METRICS: dict[str, Metric] = {
    name: metric for module, units in _RUN_UNITS.items() for name, metric in _metrics(module, units).items()
}
DRIVE_METRICS: dict[str, Metric] = _metrics("drives", _DRIVE_UNITS)

METRICS: dict[str, Metric] = RUN_METRICS | DRIVE_METRICS


def measure(signals: Signals, name: str, drive: str | None = None, least: bool = False) -> float:
    """Returns a metric of the run; a drive's without its name is the largest over the drives that have it.

    least: the smallest instead, which is the worst one where the limit is a lower one. Raises Missing, with
    the reason, where the run cannot give the number.
    """
    if name in RUN_METRICS:
        return RUN_METRICS[name].of(signals)
    prefix, _, plain = name.rpartition(".")
    chosen = [drive or prefix] if drive or prefix else signals.drives()
    values, problem = [], Missing("the run has no drives")
    for one in chosen:
        try:
            values.append(DRIVE_METRICS[plain].of(signals, one))
        except Missing as missing:
            problem = missing
    if not values:
        raise problem
    return min(values) if least else max(values)


def all_metrics(signals: Signals) -> dict[str, float]:
    """Returns every metric that the run can give by its name, those of drives as `left.load_dip`."""
    names = [*RUN_METRICS, *(f"{drive}.{name}" for drive in signals.drives() for name in DRIVE_METRICS)]
    found = {}
    for name in names:
        try:
            found[name] = measure(signals, name)
        except Missing:
            continue
    return found
