"""A mistake is answered with its place, what was given and the nearest valid word."""

from __future__ import annotations

from typing import Annotated, Literal

import pytest
from pydantic import Field, ValidationError

from hilbed import problems, yaml12
from hilbed.scenario import overlay
from hilbed.spec import Positive, Spec
from hilbed.types import ScenarioError


class Circle(Spec):
    kind: Literal["circle"] = "circle"
    radius: Positive


class Line(Spec):
    kind: Literal["line"] = "line"
    length: Positive = 1.0


class Dots(Spec):
    kind: Literal["dots"] = "dots"
    dots: Positive = 1.0  # a key that is its own kind


class Drawing(Spec):
    shapes: list[Annotated[Circle | Line | Dots, Field(discriminator="kind")]] = []
    named: dict[str, Line] = {}
    scale: Positive = 1.0


TEXT = """\
scale: -1
shapes:
  - kind: circle
    radios: 2
  - kind: square
  - {kind: line, length: long}
named:
  a: {lenght: 1}
"""


def tell(text: str, *settings: str) -> str:
    data, marks = yaml12.read(text, "f.yaml")
    places = problems.Places("f.yaml", marks)
    for setting in settings:
        places.overlaid(overlay.apply(data, setting), setting)
    with pytest.raises(ValidationError) as caught:
        Drawing.model_validate(data)
    return places.tell(problems.from_validation(caught.value, Drawing))


def test_every_problem_is_told_at_once_in_the_order_of_the_file() -> None:
    assert tell(TEXT).splitlines() == [
        "f.yaml:1: scale: input should be greater than 0, given -1",
        "f.yaml:3: shapes.0.radius is missing",
        "f.yaml:4: unknown key 'radios'; did you mean 'radius'?",
        "f.yaml:5: shapes.1: unknown kind 'square'; known: circle, dots, line",
        "f.yaml:6: shapes.2.length: input should be a valid number, given 'long'",
        "f.yaml:8: unknown key 'lenght'; did you mean 'length'?",
    ]


def test_a_value_that_was_laid_over_is_blamed_on_the_setting() -> None:
    assert tell("scale: 1\n", "scale=0") == "--set scale=0: scale: input should be greater than 0, given 0"
    assert tell("shapes: [{kind: line}]\n", "shapes.0.length=-2").startswith("--set shapes.0.length=-2: ")


def test_what_is_not_in_the_file_is_blamed_on_the_setting_that_made_its_block() -> None:
    assert tell("scale: 1\n", "named.a.lenght=1").startswith("--set named.a.lenght=1: unknown key 'lenght'")
    assert tell("scale: 1\n", "shapez.0=1").startswith("--set shapez.0=1: unknown key 'shapez'")
    assert tell("shapes: [{kind: line}]\n", "shapes.0.kind=cube").startswith("--set shapes.0.kind=cube: ")
    assert tell("shapes: [{}]\n", "scale=2") == "f.yaml:1: shapes.0 needs a kind: one of circle, line, dots"


def test_a_key_may_have_the_name_of_its_kind() -> None:
    assert tell("shapes: [{kind: dots, dots: 0}]\n") == (
        "f.yaml:1: shapes.0.dots: input should be greater than 0, given 0"
    )
    assert tell("shapes: [{kind: dots, dotz: 1}]\n").endswith("unknown key 'dotz'; did you mean 'dots'?")


@pytest.mark.parametrize("given", ["'1'", "true", "[1]", "{a: 1}", "null"])
def test_only_a_number_is_a_number(given: str) -> None:
    assert tell(f"scale: {given}\n").startswith("f.yaml:1: scale: input should be a valid number, given ")


def test_python_s_words_are_not_the_user_s() -> None:
    assert tell("named: [1]\n") == "f.yaml:1: named: input should be a block of keys and values, given [1]"
    assert tell("shapes: 1\n") == "f.yaml:1: shapes: input should be a list, given 1"


def test_what_was_given_is_told_in_short_however_large_it_is() -> None:
    bomb: object = "x"
    for _ in range(40):
        bomb = [bomb] * 9
    assert len(problems.shorten(bomb)) <= 60
    assert len(problems.shorten("x" * 10_000)) <= 60


def test_a_setting_changes_one_block_of_those_that_an_anchor_shares() -> None:
    data, _ = yaml12.read("a: &a {x: 1, y: [1, 2]}\nb: *a\n", "x")
    overlay.apply(data, "a.x=2")
    overlay.apply(data, "a.y.0=3")
    assert data == {"a": {"x": 2, "y": [3, 2]}, "b": {"x": 1, "y": [1, 2]}}


def test_settings_reach_into_lists_words_and_blocks_that_are_not_there() -> None:
    data: dict[str, object] = {"estimator": "ekf", "items": [{"a": 1}]}
    for setting in ("estimator.gate=null", "items.0.a=2", "new.block.x=[1, 2]"):
        overlay.apply(data, setting)
    assert data == {
        "estimator": {"kind": "ekf", "gate": None},
        "items": [{"a": 2}],
        "new": {"block": {"x": [1, 2]}},
    }


@pytest.mark.parametrize(
    "setting", ["seed", "=1", "seed.x=1", "items.3.a=1", "items.a=1", "items.7=1", "a=[1"]
)
def test_settings_that_lead_nowhere(setting: str) -> None:
    with pytest.raises(ScenarioError, match="--set"):
        overlay.apply({"seed": 1, "items": [{}]}, setting)
