"""Compiled parts: found only where they fit, and the same to the bit."""

from __future__ import annotations

import ast
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from hilbed import compiled

needs_compiled = pytest.mark.skipif(
    not compiled.place().is_dir(), reason="nothing compiled here: scripts/setup found no C compiler"
)

TOPS = ("firmware_sim", "hilbed")


def told(*command: object, use: str) -> str:
    environment = {**os.environ, "HILBED_COMPILED": use}
    ended = subprocess.run(
        [sys.executable, *map(str, command)], env=environment, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


@needs_compiled
@pytest.mark.parametrize("seed", range(4))
def test_a_drive_that_hears_noise_does_the_same(seed: int) -> None:
    """Both forms side by side; what they do is checked where the sources are fuzzed."""
    sources = told("-m", "tests.firmware.twin", seed, use="no").split()
    machine = told("-m", "tests.firmware.twin", seed, use="yes").split()
    assert machine[0] == sources[0]
    assert (sources[1], machine[1]) == ("False", "True")


@needs_compiled
@pytest.mark.parametrize(
    "run",
    [
        ("demo", "duration=3"),
        ("slimane2014/duty", "duration=2"),
        ("tricycle/homing", "duration=2"),
        ("bui2022/closed-loop-bench", "duration=2"),
    ],
)
def test_a_run_has_the_same_hash(tmp_path: Path, run: tuple[str, str]) -> None:
    hashes = []
    for use in ("no", "yes"):
        command = ("-m", "hilbed", "run", run[0], "--set", run[1], "--set", "criteria={}", "--json")
        verdict = json.loads(told(*command, "--out", tmp_path / use, use=use))
        hashes.append(verdict["hash"])
    assert hashes[0] == hashes[1]


@needs_compiled
def test_every_module_is_compiled_that_should_be() -> None:
    names = {".".join(path.with_suffix("").parts) for path in compiled.modules()}
    assert {"firmware_sim.axis", "hilbed.can.wire", "hilbed.estimation.ekf"} < names
    found = {name for name in compiled.Compiled().files if "__mypyc" not in name}
    assert found == names


def test_after_a_change_of_the_sources_they_run_themselves(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    unwanted = shutil.ignore_patterns("__pycache__")
    for package in TOPS:
        shutil.copytree(compiled.ROOT / package, tmp_path / package, ignore=unwanted)
    before = compiled.place()
    monkeypatch.setattr(compiled, "ROOT", tmp_path)
    assert compiled.place() == before
    with (tmp_path / "firmware_sim" / "ramp.py").open("a") as source:
        source.write("# changed\n")
    assert compiled.place() != before
    assert compiled.Compiled().find_spec("firmware_sim.ramp") is None


def test_all_that_compiled_modules_import_of_hilbed_counts() -> None:
    counted = {path.relative_to(compiled.ROOT) for path in compiled.sources()}
    for path in compiled.modules():
        for node in ast.walk(ast.parse((compiled.ROOT / path).read_text())):
            if isinstance(node, ast.ImportFrom) and str(node.module).split(".")[0] in TOPS:
                module = Path(*str(node.module).split("."))
                within = {module / f"{alias.name}.py" for alias in node.names}
                assert counted & {module.with_suffix(".py"), module / "__init__.py", *within}, (path, module)


def test_nothing_else_is_looked_for() -> None:
    finder = compiled.Compiled()
    assert finder.find_spec("json") is None
    assert finder.find_spec("hilbed.loop") is None
    assert "files" not in vars(finder), "imports of anything else cost no look at the disk"
