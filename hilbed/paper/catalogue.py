"""What the papers show, and in which order: data beside this module, one file a paper."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from hilbed import yaml12
from hilbed.problems import nearest
from hilbed.spec import Listed, Spec
from hilbed.types import ScenarioError

FOLDER = Path(__file__).parent / "papers"
NAMES = sorted(file.stem for file in FOLDER.glob("*.yaml"))

Drawing = Literal[
    "path", "states", "errors", "tracking", "commands", "landmark", "observability",
    "speeds", "efforts", "nis",
]  # fmt: skip
Triple = Listed[tuple[float, float, float]]


class Claim(Spec):
    """A number or a statement of the paper beside ours.

    ours: a metric of the scenario; `final` for the true pose at the end; `cost/PART` for ms a cycle.
    """

    what: str
    printed: str
    scenario: str
    ours: str


class Table(Spec):
    """Final poses over many runs: every scenario with every one of `seeds` (first, last).

    mean, std: as printed, of x (m), y (m), yaw (rad).
    """

    scenarios: list[str]
    seeds: Listed[tuple[int, int]]
    mean: Triple
    std: Triple


class Section(Spec):
    """One figure or table of the paper: its scenarios, with their twins, and what is drawn of each."""

    title: str
    text: str = ""
    scenarios: list[str] = []
    draw: list[Drawing] = ["path"]
    claims: list[Claim] = []
    table: Table | None = None


class Paper(Spec):
    """One paper; mended: its misprints; free: what it does not say and we had to choose."""

    title: str
    sections: Annotated[list[Section], Field(min_length=1)]
    mended: list[str] = []
    free: list[str] = []

    def scenarios(self) -> list[str]:
        """Returns the scenarios in the order in which they first appear."""
        return list(dict.fromkeys(name for section in self.sections for name in section.scenarios))


def read(name: str) -> Paper:
    """Returns a paper; raises ScenarioError with the nearest name."""
    if name not in NAMES:
        raise ScenarioError(f"unknown paper {name!r}{nearest(name, NAMES)}")
    file = FOLDER / f"{name}.yaml"
    data, _ = yaml12.read(file.read_text(encoding="utf-8"), str(file))
    return Paper.model_validate(data)
