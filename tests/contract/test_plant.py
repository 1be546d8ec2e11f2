"""What every Plant does: time moves only by `advance`, and in parts as in one go."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from hilbed.build import Bench, build
from hilbed.cost import Cost
from hilbed.plant.recorded import Recorded
from hilbed.plant.recorded_spec import RecordedSpec
from hilbed.plant.recording import load as load_recording
from hilbed.plant.replay import RecordedPlant
from hilbed.ports import Plant
from hilbed.record.notes import Notes
from hilbed.scenario.load import load
from hilbed.types import Command, Truth
from tests.build.scenarios import small
from tests.recorded.files import write

MS = 1_000_000


@contextmanager
def simulated(folder: Path) -> Iterator[Plant]:
    """A robot that sets off now; its drives take a target over at the SYNC after it."""
    bench: Bench = build(load(str(small(folder))), Notes(), Cost())
    try:
        bench.boot(lambda: None)
        plant, base, command = bench.rig.plant, bench.rig.base, Command(0.4, 0.5)
        base.write(0, command)
        plant.advance(0, 10 * MS)
        base.write(10 * MS, command)
        yield plant
    finally:
        bench.close()


@contextmanager
def recorded(folder: Path) -> Iterator[Plant]:
    spec = RecordedSpec(kind="recorded", file="robot.npz")
    yield RecordedPlant(Recorded(spec, load_recording(write(folder))))


PLANTS = {"simulated": simulated, "recorded": recorded}


def moved(kind: str, folder: Path, stops: list[int]) -> list[Truth]:
    """Returns the truth at the start and at each stop (ms after it)."""
    with PLANTS[kind](folder) as plant:
        seen = [plant.truth()]
        for stop in stops:
            plant.advance(seen[-1].t, seen[0].t + stop * MS)
            seen.append(plant.truth())
            assert plant.truth() == seen[-1], "looking changes nothing"
        return seen


@pytest.mark.parametrize("kind", PLANTS)
def test_the_truth_has_the_time_it_was_moved_to(tmp_path: Path, kind: str) -> None:
    seen = moved(kind, tmp_path, [10, 20, 90])
    assert [truth.t - seen[0].t for truth in seen] == [0, 10 * MS, 20 * MS, 90 * MS]


@pytest.mark.parametrize("kind", PLANTS)
def test_in_parts_it_moves_as_in_one_go(tmp_path: Path, kind: str) -> None:
    start, whole = moved(kind, tmp_path, [90])
    parts = moved(kind, tmp_path, [1, 2, 33, 34, 89, 90])
    assert (parts[0], parts[-1]) == (start, whole)


def test_the_simulated_one_moves(tmp_path: Path) -> None:
    start, end = moved("simulated", tmp_path, [90])
    assert end.pose.x > start.pose.x + 0.01
    assert end.pose.yaw > start.pose.yaw + 0.005
