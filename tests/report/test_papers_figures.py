"""What the papers' robots and estimators add to a report: steering, landmarks, clouds."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from hilbed.criteria import Signals
from hilbed.report import cloud_figures, drive_figures, pose_figures, state_figures, style, write_report
from hilbed.report.run import Run, read_run
from tests.report import synthetic


def tricycle(folder: Path, rows: int | None = None) -> Run:
    """A run with a steering axis, a landmark distance and clouds, cut to its first rows."""
    written = synthetic.write(folder)
    with np.load(written / "signals.npz") as archive:
        signals = dict(archive)
    t = signals["t"]
    signals = {name: signals[name][:rows] for name in ("t", "truth", "estimate", "reference", "odometry")} | {
        "covariance": np.full((len(t), 3, 3), np.nan)[:rows],
        "landmark_distance": np.linspace(0.5, 6.0, len(t))[:rows],
        "beacons": np.array([(0.0, 0.0), (0.0, 6.0)]),
        "drive/steering/angle": 0.3 * np.sin(t)[:rows],
        "drive/steering/angle_ref": 0.3 * np.sin(t + 0.05)[:rows],
        "drive/steering/speed_ref": np.zeros(len(t))[:rows],
        "drive/steering/slip": np.ones(len(t))[:rows],
        "cloud/t": t[[0, 5]][: None if rows is None else min(rows, 2)],
        "cloud/particles": np.ones((2, 9, 3))[: None if rows is None else min(rows, 2)],
    }
    np.savez(written / "signals.npz", **signals)
    return read_run(written)


def test_each_has_its_place_on_the_page(tmp_path: Path) -> None:
    run = tricycle(tmp_path / "run")
    page = write_report(run.folder).read_text()
    titles = re.findall("<h2>([^<]*)</h2>", page)
    assert {"Steering angle", "Distance of the landmarks", "Observability", "Clouds"} <= set(titles)
    assert "Wheel speeds" not in titles
    assert not any(title.startswith("Slip") for title in titles), "a steering axis does not roll"
    assert "3 σ" not in page, "the estimator states no covariance"


@pytest.mark.parametrize("rows", [0, 1])
def test_a_run_that_has_hardly_begun_has_a_report(tmp_path: Path, rows: int) -> None:
    run = tricycle(tmp_path / "run", rows)
    assert write_report(run.folder).exists()


def test_other_runs_have_none_of_them(tmp_path: Path) -> None:
    run = read_run(synthetic.write(tmp_path / "run"))
    for draw in (
        drive_figures.steering, state_figures.landmark, state_figures.observability, cloud_figures.clouds
    ):  # fmt: skip
        assert draw(run) is None


def test_observability_vanishes_where_the_axis_passes_through_a_landmark(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    drawn: list[np.ndarray] = []

    def keep(figure: Figure, _: str) -> str:
        drawn.extend(np.asarray(line.get_ydata()) for axes in figure.axes for line in axes.lines)
        return ""

    monkeypatch.setattr(style, "svg", keep)
    t = np.linspace(0.0, 1.0, 101)
    truth = np.column_stack((np.full(101, 2.0), np.full(101, 0.0), (t - 0.5)))  # turns past the origin
    beacons = np.array([(0.0, 0.0), (0.0, 1.0)])
    run = Run(Path(), "", {}, Signals(t=t, truth=truth, landmark_distance=t, beacons=beacons), (), (), ())
    state_figures.observability(run)
    determinant, straight, steering = drawn
    assert determinant[50] == pytest.approx(0.0, abs=1e-11)
    assert straight[50] == pytest.approx(0.0, abs=1e-11)
    assert steering[50] > 1e-2
    across = np.abs(np.sin(truth[:, 2])), np.abs(np.sin(truth[:, 2] + np.arctan2(1.0, 2.0)))
    assert determinant == pytest.approx(across[0] * across[1] / (2.0 * np.sqrt(5.0)) ** 3, abs=1e-11)


def test_steering_and_errors_show_what_was_recorded(tmp_path: Path) -> None:
    run = tricycle(tmp_path / "run")
    with style.drawing():
        steering, errors = drive_figures.steering(run), pose_figures.errors(run)
    assert steering is not None
    assert errors is not None
    assert "steering angle and its reference" in steering
