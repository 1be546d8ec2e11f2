"""What `hilbed run` and `hilbed list` do: a run with its folder, its table and its report."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from hilbed import verdict
from hilbed.busnames import Asked, bus_settings
from hilbed.clock import seconds
from hilbed.console import Stop, end_progress, progress, quiet_pipe, stop_on_signal
from hilbed.record.folder import RunFolder
from hilbed.report import write_report
from hilbed.runner import Outcome, Watch, perform, processors
from hilbed.scenario import bundled
from hilbed.scenario.load import Loaded, load, version_warnings
from hilbed.types import Cycle, HilbedError
from hilbed.versions import versions


def run(options: argparse.Namespace) -> int:
    """Runs a scenario into its folder, prints the verdict and returns the exit status."""
    loaded = _loaded(options)
    for warning in version_warnings(loaded.scenario, versions()):
        print(f"warning: {warning}", file=sys.stderr)
    folder = RunFolder(options.out or _default_folder(loaded), options.force)
    with stop_on_signal() as stop:
        outcome = perform(loaded, folder, _watch(loaded, stop), processors() > 1, options.arm)
    if outcome.trace:
        print(f"{outcome.trace}This is a mistake in hilbed, not in the scenario.", file=sys.stderr)
    report = _report(folder.path, loaded)
    with quiet_pipe():
        _tell(outcome, folder.path, report, options.json)
    return outcome.status


def _loaded(options: argparse.Namespace) -> Loaded:
    """Reads the scenario with all that the command line, or CAN_INTERFACE, lays over it."""
    settings = list(options.settings)
    if options.record is not None:
        settings.append(f"record={options.record}")
    loaded = load(options.scenario, settings, options.seed, options.detector)
    if options.realtime and loaded.scenario.realtime is None:
        settings.append("realtime={}")
    asked = Asked(options.interface, options.channel, options.bitrate)
    settings += bus_settings(asked, loaded.scenario.bus)
    if settings == options.settings:
        return loaded
    return load(options.scenario, settings, options.seed, options.detector)


def _default_folder(loaded: Loaded) -> Path:
    return Path("runs") / f"{loaded.name}-{loaded.scenario.seed}"


def _watch(loaded: Loaded, stop: Stop) -> Watch:
    shown = -1

    def cycle(cycle: Cycle) -> None:
        nonlocal shown
        second = int(seconds(cycle.t))
        if second != shown:
            shown = second
            progress(f"{loaded.name}: {second} of {loaded.scenario.duration:g} s")

    return Watch(lambda: stop.signal, cycle)


def _report(folder: Path, loaded: Loaded) -> Path | None:
    if loaded.scenario.record == "none":
        return None
    progress("writing the report")
    try:
        return write_report(folder)
    except HilbedError as error:
        print(f"no report: {error}", file=sys.stderr)
        return None
    finally:
        end_progress()


def _tell(outcome: Outcome, folder: Path, report: Path | None, as_json: bool) -> None:
    if as_json:
        print(json.dumps(outcome.verdict, indent=2))
        return
    print(verdict.table(outcome.verdict, colour=verdict.coloured(sys.stdout)))
    print(f"report: {report}" if report else f"run: {folder}")


LISTED = ("scenario", "robot", "plant", "estimator", "controller", "what it shows")


def print_scenarios() -> int:
    """Prints the bundled scenarios, one a line; in a terminal below a line that says what the columns are."""
    head = [LISTED] if sys.stdout.isatty() else []
    rows = [*head, *(_row(name) for name in bundled.names())]
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    for row in rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())
    return 0


def _row(name: str) -> tuple[str, ...]:
    summary = bundled.summary(name)
    return name, *summary
