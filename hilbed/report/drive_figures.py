"""Figures of the drives: speeds, duties, currents, slip."""

from __future__ import annotations

import numpy as np

from hilbed.report import style
from hilbed.report.run import Run


def speeds(run: Run) -> str | None:
    """Returns each wheel's speed over its reference; None without driven wheels."""
    names = [name for name in run.signals.drives() if _has(run, name, "speed_ref")]
    names = [name for name in names if not _steers(run, name)]
    if not names:
        return None
    figure, axes = style.sheet(len(names), 1.2 + 1.6 * len(names))
    for one, name, colour in zip(axes, names, style.DRIVES, strict=False):
        measured = "speed" if _has(run, name, "speed") else "speed_measured"
        t, reference = _column(run, name, "speed_ref")
        one.plot(t, reference, color=style.STAND_IN["reference"], linewidth=2.6, label="reference")
        t, speed = _column(run, name, measured)
        one.plot(t, speed, color=style.STAND_IN[colour], linewidth=0.9, label=name)
        one.set_ylabel("speed  [rad/s]")
        style.legend(one, 12.0 if one is axes[0] else 1.0)
    style.on_time(axes, run.signals["t"], run.spans)
    return style.svg(figure, "wheel speeds and references")


def steering(run: Run) -> str | None:
    """Returns the angle of a steering axis over its reference, and their difference; None without one."""
    names = [name for name in run.signals.drives() if _steers(run, name)]
    if not names:
        return None
    t, reference = run.signals["t"], run.signals[f"drive/{names[0]}/angle_ref"]
    angle = run.signals.get(f"drive/{names[0]}/angle", run.signals.get(f"drive/{names[0]}/angle_measured"))
    assert angle is not None
    figure, axes = style.sheet(2, 3.6)
    for column, colour, width, label in (
        (reference, "reference", 2.6, "reference"), (angle, "estimate", 0.9, names[0]),
    ):  # fmt: skip
        thin_t, thin = style.thinned(t, np.degrees(column))
        axes[0].plot(thin_t, thin, color=style.STAND_IN[colour], linewidth=width, label=label)
    axes[0].set_ylabel("angle  [°]")
    thin_t, error = style.thinned(t, np.degrees(angle - reference))
    axes[1].plot(thin_t, error, color=style.STAND_IN["bad"])
    axes[1].set_ylabel("angle − ref.  [°]")
    style.legend(axes[0])
    style.on_time(axes, t, run.spans)
    return style.svg(figure, "steering angle and its reference")


def efforts(run: Run) -> str | None:
    """Returns duties, currents and load torques of all drives; None where all are absent or zero."""
    return _stacked(
        run,
        (("duty", "duty", 100.0, "%"), ("current", "current", 1.0, "A"), ("load_torque", "load", 1.0, "N m")),
        "duties, currents and load torques",
        run.signals.drives(),
    )


def slip(run: Run) -> str | None:
    """Returns the slip of all driven wheels; None where it is absent or zero."""
    wheels = [name for name in run.signals.drives() if not _steers(run, name)]
    return _stacked(run, (("slip", "slip", 100.0, "cm/s"),), "slip of the wheels", wheels)


def _stacked(
    run: Run, fields: tuple[tuple[str, str, float, str], ...], label: str, drives: list[str]
) -> str | None:
    rows = [field for field in fields if any(_moves(run, name, field[0]) for name in drives)]
    if not rows:
        return None
    figure, axes = style.sheet(len(rows), 1.3 + 1.03 * len(rows))
    for one, (field, word, scale, unit) in zip(axes, rows, strict=True):
        for name, colour in zip(drives, style.DRIVES, strict=False):
            if _has(run, name, field):
                t, column = _column(run, name, field)
                one.plot(t, column * scale, color=style.STAND_IN[colour], linewidth=0.9, label=name)
        one.set_ylabel(f"{word}  [{unit}]")
    style.legend(axes[0])
    style.on_time(axes, run.signals["t"], run.spans)
    return style.svg(figure, label)


def _steers(run: Run, drive: str) -> bool:
    return f"drive/{drive}/angle_ref" in run.signals


def _has(run: Run, drive: str, field: str) -> bool:
    return f"drive/{drive}/{field}" in run.signals or f"tick/drive/{drive}/{field}" in run.signals


def _moves(run: Run, drive: str, field: str) -> bool:
    return _has(run, drive, field) and bool(np.nan_to_num(run.signals.drive(drive, field)).any())


def _column(run: Run, drive: str, field: str) -> tuple[style.Column, ...]:
    column = run.signals.drive(drive, field)
    tick = run.signals.get("tick/t")
    t = tick if tick is not None and len(tick) == len(column) else run.signals["t"]
    return style.thinned(t, column)
