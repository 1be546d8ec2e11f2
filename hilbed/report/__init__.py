"""One self-contained HTML page on a finished run."""

from __future__ import annotations

from html import escape
from pathlib import Path

from hilbed.criteria import Missing
from hilbed.record.folder import REPORT, write_whole
from hilbed.report import page
from hilbed.report.run import ReportError, Run, read_run


def write_report(folder: Path) -> Path:
    """Writes report.html into a run folder and returns its path.

    Parts that the run lacks are left out. Raises HilbedError where the folder is not a run's, or is full.
    """
    run = read_run(folder)
    try:
        text = _page(run)
    except (Missing, ArithmeticError, LookupError, TypeError, ValueError) as error:
        raise ReportError(f"{folder} holds a run that cannot be shown: {error!r}") from error
    write_whole(folder / REPORT, text.encode())
    return folder / REPORT


def _page(run: Run) -> str:
    grid = _summary(run) + _figures(run) + _details(run)
    body = page.banner(run) + page.disturbances(run) + f'<div class="grid">{grid}</div>' + page.files(run)
    return page.document(run, body)


def _summary(run: Run) -> str:
    return page.card("Criteria", page.criteria(run)) + page.card("Cost", page.cost(run))


def _figures(run: Run) -> str:
    from hilbed.report import (
        bus_figures,
        cloud_figures,
        drive_figures,
        pose_figures,
        position_figures,
        sensor_figures,
        state_figures,
        style,
        time_figures,
    )

    with style.drawing():
        cards = [
            page.card("Path", pose_figures.path(run)),
            page.card("Error of the estimate", pose_figures.errors(run)),
            page.card("Distance of the landmarks", state_figures.landmark(run)),
            page.card("Observability", state_figures.observability(run)),
            page.card("Clouds", cloud_figures.clouds(run)),
            page.card("Wheel speeds", drive_figures.speeds(run)),
            page.card("Steering angle", drive_figures.steering(run)),
            page.card("Duties, currents, loads", drive_figures.efforts(run)),
            page.card("Distance to truth", pose_figures.tracking(run)),
            page.card("Slip: surface of the wheel against the ground", drive_figures.slip(run)),
            page.card("Azimuth residuals, by beacon", sensor_figures.residuals(run, "azimuth")),
            page.card("Range residuals, by beacon", sensor_figures.residuals(run, "range")),
            page.card("Position residuals", position_figures.residuals(run)),
            page.card("Innovations", sensor_figures.nis(run)),
            page.card("Bus load in each 0.1 s", bus_figures.bus_load(run)),
            page.card("Bus latency by identifier", bus_figures.latency(run)),
            page.card("Real time", time_figures.lateness(run), time_figures.summary(run)),
            page.card("Counted", page.counts(run), wide=True),
        ]
    return "".join(cards)


def _details(run: Run) -> str:
    from hilbed.report import attribution_table, bus_table

    scenario = f"<pre>{escape(run.scenario)}</pre>"
    return (
        page.card(
            "What the error is made of", attribution_table.table(run), attribution_table.NOTE, wide=True
        )
        + page.card(
            "Camera", page.shots(run), "detections are lines, beacons known by their number", wide=True
        )
        + page.card("Frames without an answer of the detector", page.detectors(run), wide=True)
        + page.card("Frames by identifier", bus_table.frames(run), bus_table.NOTE, wide=True)
        + page.card("Metrics", page.metrics(run), wide=True)
        + page.card("Scenario", scenario, "resolved: every default written out", wide=True)
    )
