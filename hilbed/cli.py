"""The command line: human text on stderr, results on stdout, exit statuses as the contract says."""

from __future__ import annotations

import argparse
import os
import signal
import sys
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn, TypeAlias

from hilbed import __version__, compiled
from hilbed.busoptions import add_bus
from hilbed.drive.arguments import add_options as add_drive_options

# Nothing else of the bench is imported up here: what takes time happens where an interrupt is waited for.

INTERRUPTED, BROKEN, REFUSED, BUS = 2, 3, 4, 7

Options = argparse.Namespace


class _Parser(argparse.ArgumentParser):
    """An argparse parser whose errors are found before the first cycle, so they end with 4."""

    def error(self, message: str) -> NoReturn:
        self.print_usage(sys.stderr)
        self.exit(REFUSED, f"{self.prog}: {message}\n")


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Runs the command that the arguments name and exits with its status."""
    try:
        signal.signal(signal.SIGTERM, signal.default_int_handler)
        # Matrices here are 3 × 3: threads only cost. To be said before numpy is imported.
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        compiled.prefer()
        status = _status(_parser().parse_args(arguments))
    except KeyboardInterrupt:
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)  # it ends already
        print("interrupted", file=sys.stderr)
        status = INTERRUPTED
    sys.exit(status)


def _status(options: Options) -> int:
    """Does what a command is there for and returns its exit status; what goes wrong is told."""
    from hilbed.console import open_streams, quiet_pipe
    from hilbed.types import BusError, HilbedError, ScenarioError

    open_streams()
    with quiet_pipe():
        try:
            status: int = options.command(options)
            return status
        except ScenarioError as error:
            print(error, file=sys.stderr)
            return REFUSED
        except BusError as error:
            print(error, file=sys.stderr)
            return BUS
        except HilbedError as error:
            print(error, file=sys.stderr)
            return BROKEN if options.command in (_run, _sweep, _paper, _bench, _frames, _vision) else REFUSED
        except BrokenPipeError:
            raise
        except OSError as error:
            print(f"{error.filename or 'output'}: {error.strerror}", file=sys.stderr)
            return BROKEN
        except Exception:
            traceback.print_exc()
            print("This is a mistake in hilbed, not in what it was given.", file=sys.stderr)
            return BROKEN
    return 0


_Commands: TypeAlias = "argparse._SubParsersAction[_Parser]"


def _parser() -> argparse.ArgumentParser:
    text = "A bench for wheeled robots that behaves like a hardware-in-the-loop rig."
    parser = _Parser(prog="hilbed", description=text)
    parser.add_argument("--version", action="version", version=f"hilbed {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True, parser_class=_Parser)

    for add in (
        _add_run,
        _add_sweep,
        _add_paper,
        _add_frames_command,
        _add_vision,
        _add_readers,
        _add_desk,
        _add_bench,
    ):
        add(commands)
    return parser


def _add_run(commands: _Commands) -> None:
    """Adds `hilbed run`."""
    run = _command(commands, "run", _run, "run a scenario and judge it")
    _add_scenario(run)
    run.add_argument("--seed", type=int, metavar="N", help="seed of all random streams")
    _add_detector(run)
    run.add_argument("--out", type=Path, metavar="DIR", help="run folder (runs/<scenario>-<seed>)")
    run.add_argument("--force", action="store_true", help="replace an existing run folder")
    run.add_argument("--json", action="store_true", help="print verdict.json on stdout and nothing else")
    run.add_argument("--record", choices=("all", "signals", "none"), help="what is written (all)")
    run.add_argument("--arm", action="store_true", help="let real drives (nodes of kind real) turn")
    run.add_argument("--realtime", action="store_true", help="pace the cycles to the wall clock")
    add_bus(run, "left out: the scenario or CAN_INTERFACE says, else all is simulated")


def _add_sweep(commands: _Commands) -> None:
    """Adds `hilbed sweep`."""
    sweep = _command(commands, "sweep", _sweep, "run a scenario over seeds and values, in parallel")
    _add_scenario(sweep)
    _add_detector(sweep)
    sweep.add_argument("--seeds", required=True, metavar="A..B", help="seeds from A to B, both included")
    sweep.add_argument("--jobs", type=int, metavar="N", help="processes at a time (one a processor)")
    sweep.add_argument("--json", action="store_true", help="print the table as JSON")


def _add_paper(commands: _Commands) -> None:
    """Adds `hilbed paper`."""
    paper = _command(commands, "paper", _paper, "run all experiments of a paper and write its page")
    paper.add_argument("paper", metavar="NAME", help="such as lages2017")
    paper.add_argument("--out", type=Path, metavar="DIR", help="folder of page and runs (runs/paper-NAME)")
    paper.add_argument("--force", action="store_true", help="run anew what the folder holds already")
    paper.add_argument("--ideal", action="store_true", help="leave the twins on the bench out")
    paper.add_argument("--seeds", type=int, metavar="N", help="runs a scenario behind tables of final poses")
    paper.add_argument("--jobs", type=int, metavar="N", help="processes at a time (one a processor)")


def _add_frames_command(commands: _Commands) -> None:
    """Adds `hilbed frames`."""
    frames = _command(commands, "frames", _frames, "render frames with truth into a dataset")
    _add_scenario(frames)
    frames.add_argument("--out", type=Path, metavar="DIR", required=True, help="folder of the dataset")
    frames.add_argument("-n", type=int, dest="count", metavar="N", help="number of frames (200)")
    frames.add_argument("--seed", type=int, metavar="N", help="seed of all random streams")
    frames.add_argument("--force", action="store_true", help="replace another dataset")


def _add_vision(commands: _Commands) -> None:
    """Adds `hilbed vision`."""
    vision = _command(commands, "vision", _vision, "score a detector on rendered frames, or on a dataset")
    vision.add_argument(
        "scenario", metavar="SCENARIO|DATASET|FRAMES",
        help="a scenario, a folder of hilbed frames; or frames without truth, of which the detections are "
        "printed: a folder of images, a video, a camera's index or URL, a run folder",
    )  # fmt: skip
    _add_frames(vision)
    _add_settings(vision)
    _add_detector(vision)
    vision.add_argument("-n", type=int, dest="count", metavar="N", help="number of frames (200)")
    vision.add_argument("--seed", type=int, metavar="N", help="seed of all random streams")
    vision.add_argument("--out", type=Path, metavar="DIR", help="folder of page and numbers (runs/vision-…)")
    vision.add_argument("--vary", metavar="PATH=V1,V2", help="frames with each value, in one score")
    vision.add_argument("--sweep", metavar="PATH=V1,V2", help="whole runs with each value instead")
    vision.add_argument("--seeds", metavar="A..B", help="seeds of the runs of --sweep (the scenario's)")
    vision.add_argument("--jobs", type=int, metavar="N", help="processes at a time (one a processor)")
    vision.add_argument("--force", action="store_true", help="replace what an earlier command has written")
    vision.add_argument("--json", action="store_true", help="print vision.json on stdout and nothing else")


def _add_readers(commands: _Commands) -> None:
    """Adds what reads scenarios and finished runs."""
    _command(commands, "list", _list, "list the bundled scenarios")
    check = _command(commands, "check", _check, "validate a scenario and print every error with its line")
    _add_scenario(check)
    report = _command(commands, "report", _report, "write report.html of a run folder again")
    report.add_argument("folder", type=Path, metavar="DIR")
    fit = _command(commands, "fit", _fit, "print the noise, delay and offset that explain a run with truth")
    fit.add_argument("run", type=Path, metavar="RUN", help="a run folder")
    fit.add_argument("--fraction", type=float, default=0.5, help="first part of the run that is used (0.5)")


def _add_desk(commands: _Commands) -> None:
    """Adds what goes with a bus: a drive, a replay, the tools."""
    from hilbed.bustools.options import add_tools
    from hilbed.conformance.options import add_options as add_conformance_options

    drive = _command(commands, "drive", _drive, "be a whole simulated drive on a bus, in real time")
    add_drive_options(drive)
    replay = _command(commands, "replay", _replay, "play a run's bus into odometry, estimator and controller")
    replay.add_argument("run", type=Path, metavar="RUN", help="a run folder")
    _add_settings(replay)
    replay.add_argument("--json", action="store_true", help="print what differs as JSON")
    add_tools(_command(commands, "bus", _bus, "look at a bus: its nodes, its frames, its DBC"))
    conformance = _command(
        commands, "conformance", _conformance, "check a CiA 402 drive on a bus, told a speed or a position"
    )
    add_conformance_options(conformance)


def _add_bench(commands: _Commands) -> None:
    """Adds `hilbed bench`."""
    bench = _command(commands, "bench", _bench, "measure floor, total and where the time goes")
    bench.add_argument("scenario", nargs="?", default="demo", metavar="SCENARIO")


def _command(commands: _Commands, name: str, function: object, text: str) -> _Parser:
    parser = commands.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
    parser.set_defaults(command=function)
    return parser


def _add_scenario(parser: _Parser) -> None:
    parser.add_argument("scenario", metavar="SCENARIO", help="a bundled scenario or a YAML file")
    _add_settings(parser)


def _add_settings(parser: _Parser) -> None:
    parser.add_argument(
        "--set", action="append", default=[], dest="settings", metavar="PATH=VALUE",
        help="lay one value over the scenario, such as controller=open_loop",
    )  # fmt: skip


def _add_detector(parser: _Parser) -> None:
    text = "of every camera: a kind, package.module:Class, file.py or file.py:Class"
    parser.add_argument("--detector", metavar="DETECTOR", help=text)


def _add_frames(parser: _Parser) -> None:
    """Adds what is to be known of frames that are not rendered."""
    frames = parser.add_argument_group("frames without truth")
    frames.add_argument("--like", metavar="SCENARIO", help="take detector, beacons and camera of a scenario")
    frames.add_argument("--calibration", type=Path, metavar="FILE", help="of the camera, as OpenCV writes it")
    frames.add_argument("--fov-deg", type=float, metavar="DEGREES", help="of a camera without calibration")
    frames.add_argument("--rate", type=float, default=30.0, metavar="HZ", help="of unstamped images (30)")
    frames.add_argument(
        "--timeout", type=float, default=5.0, metavar="S", help="for each frame of a live camera (5)"
    )


def _run(options: Options) -> int:
    from hilbed.commands import run

    return run(options)


def _sweep(options: Options) -> int:
    from hilbed.sweep import sweep

    return sweep(options)


def _paper(options: Options) -> int:
    from hilbed.paper.command import Options as Wanted
    from hilbed.paper.command import paper

    asked = Wanted(options.out, options.jobs, options.ideal, options.seeds, options.force)
    return paper(options.paper, asked)


def _frames(options: Options) -> int:
    from hilbed.vision_kit.frames import frames

    return frames(options)


def _vision(options: Options) -> int:
    from hilbed.vision_kit.command import vision

    return vision(options)


def _list(_: Options) -> int:
    from hilbed.commands import print_scenarios

    return print_scenarios()


def _check(options: Options) -> int:
    from hilbed.scenario.load import load

    loaded = load(options.scenario, options.settings)
    print(f"{loaded.name}: valid", file=sys.stderr)
    return 0


def _report(options: Options) -> int:
    from hilbed.report import write_report

    print(write_report(options.folder))
    return 0


def _fit(options: Options) -> int:
    from hilbed.fit import fit

    print(fit(options.run, options.fraction), end="")
    return 0


def _drive(options: Options) -> int:
    from hilbed.drive.process import main as drive

    return drive(options)


def _replay(options: Options) -> int:
    from hilbed.replay.command import replay

    return replay(options.run, options.settings, options.json)


def _bus(options: Options) -> int:
    from hilbed.bustools.options import bus

    return bus(options)


def _conformance(options: Options) -> int:
    from hilbed.conformance.command import main as conformance

    return conformance(options)


def _bench(options: Options) -> int:
    from hilbed.bench import bench

    return bench(options.scenario)
