"""All metrics by name: functions of the signals, and functions of the signals and one drive."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from hilbed.criteria import bus, consistency, drives, pose
from hilbed.criteria.signals import Missing, Signals


class Metric(NamedTuple):
    """How a number is taken from the signals of a run; its description is the function's docstring."""

    of: Callable[..., float]
    unit: str

    @property
    def about(self) -> str:
        """The first line of the function's docstring."""
        return (self.of.__doc__ or "").partition("\n")[0]


RUN_METRICS: dict[str, Metric] = {
    "estimate_position_rms": Metric(pose.estimate_position_rms, "m"),
    "estimate_position_max": Metric(pose.estimate_position_max, "m"),
    "estimate_position_final": Metric(pose.estimate_position_final, "m"),
    "estimate_yaw_rms": Metric(pose.estimate_yaw_rms, "rad"),
    "estimate_yaw_final": Metric(pose.estimate_yaw_final, "rad"),
    "odometry_position_rms": Metric(pose.odometry_position_rms, "m"),
    "odometry_position_final": Metric(pose.odometry_position_final, "m"),
    "odometry_yaw_rms": Metric(pose.odometry_yaw_rms, "rad"),
    "odometry_over_estimate": Metric(pose.odometry_over_estimate, ""),
    "cross_track_rms": Metric(pose.cross_track_rms, "m"),
    "cross_track_max": Metric(pose.cross_track_max, "m"),
    "reference_distance_rms": Metric(pose.reference_distance_rms, "m"),
    "reference_distance_max": Metric(pose.reference_distance_max, "m"),
    "reference_distance_final": Metric(pose.reference_distance_final, "m"),
    "reference_yaw_rms": Metric(pose.reference_yaw_rms, "rad"),
    "nees_mean": Metric(consistency.nees_mean, ""),
    "nees_position_mean": Metric(consistency.nees_position_mean, ""),
    "nis_mean": Metric(consistency.nis_mean, ""),
    "accepted_fraction": Metric(consistency.accepted_fraction, ""),
    "azimuth_count": Metric(consistency.azimuth_count, ""),
    "azimuth_spurious": Metric(consistency.azimuth_spurious, ""),
    "azimuth_bias_mdeg": Metric(consistency.azimuth_bias_mdeg, "mdeg"),
    "azimuth_std_mdeg": Metric(consistency.azimuth_std_mdeg, "mdeg"),
    "azimuth_rms_mdeg": Metric(consistency.azimuth_rms_mdeg, "mdeg"),
    "range_bias": Metric(consistency.range_bias, "m"),
    "range_std": Metric(consistency.range_std, "m"),
    "bus_load": Metric(bus.bus_load, ""),
    "bus_load_max": Metric(bus.bus_load_max, ""),
    "bus_frames": Metric(bus.bus_frames, ""),
    "bus_latency_mean": Metric(bus.bus_latency_mean, "s"),
    "bus_latency_max": Metric(bus.bus_latency_max, "s"),
}

DRIVE_METRICS: dict[str, Metric] = {
    "speed_rms_error": Metric(drives.speed_rms_error, "rad/s"),
    "load_dip": Metric(drives.load_dip, "rad/s"),
    "load_recovery": Metric(drives.load_recovery, "s"),
    "duty_chatter": Metric(drives.duty_chatter, ""),
    "step_overshoot": Metric(drives.step_overshoot, ""),
    "slip_max": Metric(drives.slip_max, "m/s"),
    "current_max": Metric(drives.current_max, "A"),
    "duty_max": Metric(drives.duty_max, ""),
}

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
