"""What the papers show, and in which order: data beside this module, one file a paper."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from hilbed import yaml12
from hilbed.problems import nearest
from hilbed.spec import Listed, NonNegative, Spec
from hilbed.types import ScenarioError

FOLDER = Path(__file__).parent / "papers"
NAMES = sorted(file.stem for file in FOLDER.glob("*.yaml"))
TWIN = "-bench"

Drawing = Literal[
    "path", "states", "errors", "tracking", "landmark", "speeds", "efforts", "nis", "steering",
    "observability", "paths", "goal", "poses", "inputs", "tracked", "located", "positions", "headings",
    "sights", "fan", "prediction", "belief", "controls",
]  # fmt: skip
Triple = Listed[tuple[float, float, float]]


class Vary(Spec):
    """One value of a scenario, by its dotted path, that takes several: a run each, without twins."""

    path: str
    values: Annotated[list[float], Field(min_length=1)]


class Figure(Spec):
    """A figure of the paper: drawn of its scenarios and, beside them, of their twins on the bench.

    name: its number in the paper, empty for one of our own; at: s, where an instant is shown; bench: whether
    the twins are shown.
    """

    name: str = ""
    caption: str
    draw: Drawing
    scenarios: Annotated[list[str], Field(min_length=1)]
    vary: Vary | None = None
    at: NonNegative = 0.0
    bench: bool = True


class Claim(Spec):
    """A number or a statement of the paper beside ours.

    ours: a metric of the scenario; `final` for the true pose at the end; `cost/PART` for ms a cycle.
    law: what a closed form says.
    """

    what: str
    printed: str = "–"
    law: str = ""
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
    """Some figures or a table of the paper that belong together, with what it says beside what came out.

    scenarios: further ones, whose criteria are shown and of which no figure is.
    """

    title: str
    text: str = ""
    figures: list[Figure] = []
    scenarios: list[str] = []
    claims: list[Claim] = []
    table: Table | None = None

    def names(self) -> list[str]:
        """Returns the scenarios of this section in the order in which they first appear."""
        drawn = [name for figure in self.figures for name in figure.scenarios]
        return list(dict.fromkeys([*drawn, *(claim.scenario for claim in self.claims), *self.scenarios]))


class Paper(Spec):
    """One paper; mended: its misprints; free: what it does not say and we had to choose."""

    title: str
    sections: Annotated[list[Section], Field(min_length=1)]
    mended: list[str] = []
    free: list[str] = []

    def scenarios(self) -> list[str]:
        """Returns the scenarios in the order in which they first appear."""
        return list(dict.fromkeys(name for section in self.sections for name in section.names()))


def read(name: str) -> Paper:
    """Returns a paper; raises ScenarioError with the nearest name."""
    if name not in NAMES:
        raise ScenarioError(f"unknown paper {name!r}{nearest(name, NAMES)}")
    file = FOLDER / f"{name}.yaml"
    data, _ = yaml12.read(file.read_text(encoding="utf-8"), str(file))
    return Paper.model_validate(data)
