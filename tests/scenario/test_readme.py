"""The commands of the README are scenarios that hold."""

import shlex
from pathlib import Path

import pytest

from hilbed.scenario.load import load

README = Path(__file__).parents[2] / "README.md"
COMMANDS = [line for line in README.read_text().splitlines() if line.startswith("scripts/run run ")]


@pytest.mark.parametrize("command", COMMANDS)
def test_a_run_of_the_readme_is_not_refused(command: str) -> None:
    words = shlex.split(command.replace(";", " ; "), comments=True)
    settings = [words[k + 1] for k, word in enumerate(words) if word == "--set"]
    load(words[2], settings)
