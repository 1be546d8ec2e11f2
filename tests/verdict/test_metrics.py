from __future__ import annotations

from math import inf

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import chi2, multivariate_normal

from hilbed.criteria import METRICS, Missing, Signals, all_metrics, measure, window
from tests.report import synthetic

T = np.arange(101) * 0.01


def poses(**columns: tuple[float, float, float]) -> Signals:
    run = Signals(t=T, covariance=np.tile(np.eye(3), (101, 1, 1)))
    for name in ("truth", "estimate", "odometry", "reference"):
        run[name] = np.tile(columns.get(name, (0.0, 0.0, 0.0)), (101, 1)).astype(float)
    return run


def test_distances_are_those_of_a_right_triangle() -> None:
    run = poses(estimate=(3.0, 4.0, 0.0), odometry=(30.0, 40.0, 0.0))
    assert measure(run, "estimate_position_rms") == pytest.approx(5.0)
    assert measure(run, "estimate_position_final") == pytest.approx(5.0)
    assert measure(run, "odometry_over_estimate") == pytest.approx(10.0)


def test_yaw_is_compared_across_the_cut() -> None:
    run = poses(truth=(0.0, 0.0, 3.1), estimate=(0.0, 0.0, -3.1), reference=(0.0, 0.0, -3.1))
    assert measure(run, "estimate_yaw_rms") == pytest.approx(2 * np.pi - 6.2)
    assert measure(run, "reference_yaw_rms") == pytest.approx(2 * np.pi - 6.2)


@given(st.floats(-3, 3), st.floats(-2, 2), st.floats(-2, 2))
def test_cross_track_is_the_distance_to_the_tangent(yaw: float, ahead: float, left: float) -> None:
    x = ahead * np.cos(yaw) - left * np.sin(yaw)
    y = ahead * np.sin(yaw) + left * np.cos(yaw)
    run = poses(truth=(1.0 + x, 2.0 + y, 0.0), reference=(1.0, 2.0, yaw))
    assert measure(run, "cross_track_rms") == pytest.approx(abs(left), abs=1e-12)
    assert measure(run, "reference_distance_max") == pytest.approx(np.hypot(ahead, left), abs=1e-12)


def test_unknown_truth_is_left_out() -> None:
    run = poses(estimate=(3.0, 4.0, 0.0))
    run["truth"][10:] = np.nan
    assert measure(run, "estimate_position_rms") == pytest.approx(5.0)
    assert np.isnan(measure(run, "estimate_position_final"))


def test_nees_of_honest_errors_has_the_mean_of_chi_square() -> None:
    rng = np.random.default_rng(3)
    root = rng.normal(size=(3, 3)) * 0.1
    covariance = root @ root.T
    count = 4000
    run = Signals(t=np.arange(count) * 0.01, truth=np.zeros((count, 3)))
    run["estimate"] = multivariate_normal(np.zeros(3), covariance).rvs(count, random_state=rng)
    run["covariance"] = np.tile(covariance, (count, 1, 1))
    for name, dof in (("nees_mean", 3), ("nees_position_mean", 2)):
        tail = chi2(count * dof)
        assert tail.ppf(1e-4) / count < measure(run, name) < tail.isf(1e-4) / count


def test_nees_skips_rows_where_everything_is_known_exactly() -> None:
    run = poses(estimate=(1.0, 1.0, 1.0))
    run["covariance"][0] = 0.0
    assert measure(run, "nees_mean") == pytest.approx(3.0)
    run["covariance"][:] = 0.0
    with pytest.raises(Missing):
        measure(run, "nees_mean")


def test_a_cloud_states_no_covariance_that_could_be_judged() -> None:
    run = Signals(synthetic.signals(1.0))
    assert {"nees_mean", "nees_position_mean"} <= set(all_metrics(run))
    run |= {"cloud/t": np.zeros(1), "cloud/particles": np.zeros((1, 9, 3))}
    assert not {"nees_mean", "nees_position_mean"} & set(all_metrics(run))


def test_azimuths_are_judged_without_the_spurious_and_across_the_cut() -> None:
    true = np.array([3.1415, -1.0, 0.5, np.nan])
    residual = np.radians([0.002, 0.004, 0.006, 50.0])
    measured = np.remainder(np.nan_to_num(true) + residual + np.pi, 2 * np.pi) - np.pi
    run = Signals(t=T)
    run |= {"azimuth/t": np.arange(4.0), "azimuth/beacon": np.array([0, 1, 2, -1])}
    run |= {"azimuth/measured": measured, "azimuth/true": true}
    run = Signals(run)
    assert measure(run, "azimuth_count") == 3
    assert measure(run, "azimuth_spurious") == 1
    assert measure(run, "azimuth_bias_mdeg") == pytest.approx(4.0)
    assert measure(run, "azimuth_std_mdeg") == pytest.approx(2.0)
    assert measure(run, "azimuth_rms_mdeg") == pytest.approx(np.sqrt(56 / 3))


def drive(speed: np.ndarray, reference: float = 5.0, load: np.ndarray | None = None) -> Signals:
    t = np.arange(len(speed)) * 1e-3
    zero = np.zeros(len(speed))
    fields = {"speed": speed, "speed_ref": zero + reference, "load_torque": zero if load is None else load}
    fields |= {"duty": zero, "slip": zero, "current": zero, "torque": zero}
    run = Signals({f"tick/drive/left/{name}": column for name, column in fields.items()})
    run |= {f"drive/left/{name}": column[::10] for name, column in fields.items()}
    run |= {"tick/t": t, "t": t[::10]}
    return Signals(run)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_load_step_has_a_dip_and_a_recovery(sign: float) -> None:
    since = np.arange(2000) * 1e-3 - 0.5
    on = (since >= 0) & (since < 1.0)
    dip = np.where(on, 0.4 * np.exp(-since / 0.03), 0.0)
    run = drive(sign * (5.0 - dip), sign * 5.0, 3.0 * on)
    assert measure(run, "left.load_dip") == pytest.approx(0.4)
    assert measure(run, "load_recovery") == pytest.approx(0.03 * np.log(0.4 / 0.1), abs=1.1e-3)


def test_what_happens_before_and_after_a_load_does_not_count() -> None:
    speed = np.full(2000, 5.0)
    speed[:100] = 0.0
    speed[1800:] = 0.0
    load = np.zeros(2000)
    load[500:1500] = 3.0
    assert measure(drive(speed, load=load), "load_dip") == 0.0
    assert measure(drive(speed, load=load), "load_recovery") == 0.0


def test_a_drive_that_does_not_recover_takes_for_ever() -> None:
    load = np.r_[np.zeros(500), np.ones(500)]
    assert measure(drive(5.0 - load, load=load), "load_recovery") == inf


def test_without_a_load_there_is_neither_dip_nor_recovery() -> None:
    with pytest.raises(Missing, match="no load torque"):
        measure(drive(np.full(100, 5.0)), "load_dip")


@given(st.floats(0.05, 0.95))
def test_overshoot_of_a_second_order_step_is_that_of_the_textbook(damping: float) -> None:
    t = np.arange(30000) * 1e-3
    w = 4.0
    wd = w * np.sqrt(1 - damping**2)
    decay = np.exp(-damping * w * t)
    speed = 5.0 * (1 - decay * (np.cos(wd * t) + damping * w / wd * np.sin(wd * t)))
    expected = np.exp(-np.pi * damping / np.sqrt(1 - damping**2))
    assert measure(drive(speed), "step_overshoot") == pytest.approx(expected, abs=1e-4)


def test_a_steering_axis_is_judged_by_its_angle_alone() -> None:
    run = drive(np.linspace(0.0, 6.0, 1000))
    assert {"left.step_overshoot", "left.slip_max", "left.speed_rms_error"} <= set(all_metrics(run))
    reference = np.full(100, 3.1)
    run |= {"drive/left/angle_ref": reference, "drive/left/angle": np.full(100, 0.03 + 3.1 - 2 * np.pi)}
    found = all_metrics(run)
    assert found["left.angle_rms_error"] == pytest.approx(0.03)
    meaningless = ("speed_rms_error", "load_dip", "load_recovery", "step_overshoot", "slip_max")
    assert not {f"left.{name}" for name in meaningless} & set(found)
    assert {"left.duty_chatter", "left.current_max", "left.duty_max"} <= set(found)
    with pytest.raises(Missing, match="left is a steering axis"):
        measure(run, "step_overshoot", "left")


def test_chatter_is_taken_over_the_end_of_the_window() -> None:
    run = drive(np.full(2000, 5.0))
    run["tick/drive/left/duty"] = np.r_[np.arange(1000) * 1.0, np.tile([0.1, 0.3], 500)]
    assert measure(run, "left.duty_chatter") == pytest.approx(0.1, rel=2e-3)


def test_the_worst_drive_counts_unless_one_is_named() -> None:
    run = drive(np.full(100, 4.0))
    run |= {name.replace("left", "right"): column.copy() for name, column in run.items()}
    run = Signals(run)
    run["tick/drive/right/speed"][:] = 3.0
    assert measure(run, "speed_rms_error") == pytest.approx(2.0)
    assert measure(run, "speed_rms_error", "left") == pytest.approx(1.0)
    assert measure(run, "right.speed_rms_error") == pytest.approx(2.0)
    assert measure(run, "speed_rms_error", least=True) == pytest.approx(1.0)  # under a lower limit


def test_bus_load_is_the_part_of_time_with_frames() -> None:
    t = np.arange(1000) * 1e-3 + 5e-4
    run = Signals(t=T)
    run |= {"bus/t": t, "bus/duration": np.where(t < 0.1, 5e-4, 2e-4), "bus/latency": t * 1e-3}
    run |= {"bus/error": np.zeros(1000, np.int64)}
    run = Signals(run)
    assert measure(run, "bus_load") == pytest.approx(0.23)
    assert measure(run, "bus_load_max") == pytest.approx(0.5)
    assert measure(run, "bus_latency_max") == pytest.approx(0.9995e-3)
    assert (measure(run, "bus_frames"), measure(run, "bus_errors")) == (1000, 0)
    run["bus/error"][-100:] = 1
    assert (measure(run, "bus_frames"), measure(run, "bus_errors")) == (900, 100)
    assert measure(run, "bus_latency_max") == pytest.approx(0.8995e-3), "error frames are no latency"
    assert measure(run, "bus_load") == pytest.approx(0.23), "but they take the bus"


def test_a_window_cuts_every_signal_by_its_own_time() -> None:
    run = window(synthetic.signals(5.0), 1.0, 2.0)
    assert (run["t"][0], run["t"][-1], len(run["truth"])) == (1.0, 2.0, 101)
    assert len(run["tick/drive/left/speed"]) == 1001
    assert len(run["azimuth/measured"]) == len(run["azimuth/t"]) == 22
    assert len(run["bus/latency"]) == len(run["bus/t"])


def test_every_metric_is_described_and_comes_out_of_a_full_run() -> None:
    run = Signals(synthetic.signals(20.0))
    found = all_metrics(run)
    missing = [name for name in METRICS if name not in found and f"left.{name}" not in found]
    simulated = ["missed_deadlines", "lateness_p99", "lateness_max"]
    sensed = ["range_bias", "range_std", "position_count", "position_rms"]
    assert missing == ["landmark_distance_error_max", *sensed, *simulated, "angle_rms_error"]
    assert all(np.isfinite(value) for value in found.values())
    assert all(metric.about.endswith(".") for metric in METRICS.values())


@pytest.mark.parametrize("kind", ["position", "pose"])
def test_measured_positions_are_compared_with_true_ones(kind: str) -> None:
    true = np.zeros((4, 3 if kind == "pose" else 2))
    measured = true.copy()
    measured[0, :2], measured[1, :2], measured[2, :2] = (0.3, 0.4), (0.0, -0.1), (np.nan, np.nan)
    run = Signals({f"{kind}/t": np.arange(4.0), f"{kind}/true": true, f"{kind}/measured": measured})
    assert measure(run, "position_count") == 4
    assert measure(run, "position_rms") == pytest.approx(np.sqrt((0.25 + 0.01) / 3))


def test_a_run_that_never_began_gives_no_number_and_no_error() -> None:
    run = Signals({name: column[:0] for name, column in synthetic.signals(1.0).items()})
    assert not any(value != 0 and np.isfinite(value) for value in all_metrics(run).values())
    with pytest.raises(Missing):
        measure(Signals(t=T), "estimate_position_rms")
    with pytest.raises(Missing, match="no drives"):
        measure(Signals(t=T), "load_dip")
