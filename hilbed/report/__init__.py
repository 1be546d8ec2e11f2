"""One self-contained HTML page on a finished run."""

from __future__ import annotations

from html import escape
from pathlib import Path

from hilbed.report import page
from hilbed.report.run import Run, read_run

REPORT = "report.html"


def write_report(folder: Path) -> Path:
    """Writes report.html into a run folder and returns its path.

    Parts that the run lacks are left out. Raises HilbedError where the folder is not a run's, or is full.
    """
    from hilbed.record.folder import write_whole

    run = read_run(folder)
    write_whole(folder / REPORT, _page(run).encode())
    return folder / REPORT


def _page(run: Run) -> str:
    grid = _summary(run) + _figures(run) + _details(run)
    body = page.banner(run) + page.disturbances(run) + f'<div class="grid">{grid}</div>' + page.files(run)
    return page.document(run, body)


def _summary(run: Run) -> str:
    return page.card("Criteria", page.criteria(run)) + page.card("Cost", page.cost(run), "s of wall time")


def _figures(run: Run) -> str:
    from hilbed.report import bus_figures, drive_figures, pose_figures, sensor_figures, style

    in_colour = "in the beacon's colour"
    with style.drawing():
        cards = [
            page.card("Path", pose_figures.path(run)),
            page.card("Error of the estimate", pose_figures.errors(run)),
            page.card("Distance to truth", pose_figures.tracking(run)),
            page.card("Wheel speeds", drive_figures.speeds(run)),
            page.card("Duties, currents, loads", drive_figures.efforts(run)),
            page.card("Slip", drive_figures.slip(run), "surface of the wheel against the ground"),
            page.card("Azimuth residuals", sensor_figures.residuals(run, "azimuth"), in_colour),
            page.card("Range residuals", sensor_figures.residuals(run, "range"), in_colour),
            page.card("Innovations", sensor_figures.nis(run)),
            page.card("Bus load", bus_figures.bus_load(run), "part of each 0.1 s with a frame on the bus"),
            page.card("Bus latency", bus_figures.latency(run)),
        ]
    return "".join(cards)


def _details(run: Run) -> str:
    scenario = f"<pre>{escape(run.scenario)}</pre>"
    return (
        page.card("Camera", page.shots(run), "detections are lines, beacons known by their number", wide=True)
        + page.card("Metrics", page.metrics(run), wide=True)
        + page.card("Scenario", scenario, "resolved: every default written out", wide=True)
    )
