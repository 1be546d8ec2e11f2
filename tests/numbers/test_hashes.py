"""Same scenario and seed, same hash: again in one process, after other runs, with cameras elsewhere."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from hilbed.record.folder import RunFolder
from hilbed.runner import perform
from hilbed.scenario.load import load
from tests.program.hilbed import hilbed

SHORT = ("duration=1.5", "disturbances.1.start=0.5")


def hashes(name: str = "demo", seed: int = 1, separate: bool = False) -> tuple[str, str]:
    content = perform(load(name, SHORT, seed), None, separate=separate).verdict
    return content["hash"], content["signals_hash"]


def test_in_one_process_whatever_ran_before() -> None:
    first = hashes()
    other = hashes("slimane2014/tracking-stadium", seed=2)
    assert hashes() == first
    assert hashes(separate=True) == first, "the camera in a process of its own"
    assert hashes("slimane2014/tracking-stadium", seed=2) == other != first


@pytest.mark.parametrize("record", ["all", "signals"])
def test_with_the_recorders_of_a_folder(tmp_path: Path, record: str) -> None:
    loaded = load("demo", [*SHORT, f"record={record}"], 1)
    content = perform(loaded, RunFolder(tmp_path / "run")).verdict
    assert (content["hash"], content["signals_hash"]) == hashes()


def test_in_another_process(tmp_path: Path) -> None:
    settings = [word for setting in SHORT for word in ("--set", setting)]
    ended = hilbed("run", "demo", *settings, "--seed", "1", "--json", "--out", tmp_path / "run")
    content = json.loads(ended.out)
    assert (content["hash"], content["signals_hash"]) == hashes()
