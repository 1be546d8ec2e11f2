"""A user's mistake answered with file, line, key, what was given and the nearest valid word."""

from __future__ import annotations

import reprlib
import types
from collections.abc import Iterator, Sequence
from difflib import get_close_matches
from typing import Annotated, Any, Literal, NamedTuple, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from hilbed import yaml12


class Problem(NamedTuple):
    """Something wrong at a path of the scenario."""

    path: yaml12.Path
    message: str


class Places:
    """Says where a path of the scenario was written: a line of the file or a `--set`."""

    def __init__(self, name: str, marks: yaml12.Marks) -> None:
        self._name = name
        self._marks = marks
        self._settings: list[tuple[yaml12.Path, str]] = []

    def overlaid(self, path: yaml12.Path, setting: str) -> None:
        """Notes that `--set` has written the value at `path`."""
        self._settings.append((path, setting))

    def of(self, path: Sequence[str | int]) -> str:
        """Returns `file:line` or `--set PATH=VALUE`.

        What is not in the file, such as a key that is missing, belongs to the setting that made its block.
        """
        path = tuple(path)
        for written, setting in reversed(self._settings):
            if path[: len(written)] == written:
                return f"--set {setting}"
        block = path
        while not self._marks.hold(block):
            for written, setting in reversed(self._settings):
                if written[: len(block)] == block:
                    return f"--set {setting}"
            block = block[:-1]
        return f"{self._name}:{self._marks.line(path)}"

    def tell(self, problems: Sequence[Problem]) -> str:
        """Returns every problem, one a line, in the order of the file."""
        lines = sorted(problems, key=lambda problem: self._marks.line(problem.path))
        return "\n".join(f"{self.of(path)}: {message}" for path, message in lines)


def from_validation(error: ValidationError, model: type[BaseModel]) -> list[Problem]:
    """Turns pydantic's errors into problems with the words that would do."""
    return [_problem(dict(item), model) for item in error.errors(include_url=False)]


def _problem(item: dict[str, Any], model: type[BaseModel]) -> Problem:
    path = untagged(model, item["loc"])
    message = _message(item, ".".join(map(str, path)), model)
    return Problem((*path, "kind") if item["type"] == "union_tag_invalid" else path, message)


def _message(item: dict[str, Any], key: str, model: type[BaseModel]) -> str:
    path, kind, given = item["loc"], item["type"], item["input"]
    context = item.get("ctx", {})
    if kind == "extra_forbidden":
        return f"unknown key {shorten(path[-1])}{nearest(str(path[-1]), keys_at(model, path[:-1]))}"
    if kind == "missing":
        return f"{key} is missing"
    if kind == "union_tag_not_found":
        return f"{key} needs a kind: one of {', '.join(kinds_at(model, path))}"
    if kind == "union_tag_invalid":
        tag = str(context["tag"])
        return f"{key}: unknown kind {shorten(tag)}{nearest(tag, _words(context).split(', '))}"
    if kind == "literal_error":
        words = [word.strip("' ") for word in str(context["expected"]).replace(" or ", ", ").split(",")]
        return f"{key}: {shorten(given)}{nearest(given if isinstance(given, str) else '', words)}"
    if kind == "value_error":
        why = str(context.get("error", item["msg"]))
        return f"{key}: {why}" if key else why
    why = _SHAPES.get(kind) or f"{item['msg'][0].lower()}{item['msg'][1:]}"
    return f"{key}: {why}, given {shorten(given)}"


_BLOCK, _LIST = "input should be a block of keys and values", "input should be a list"
_SHAPES = {
    "model_type": _BLOCK, "model_attributes_type": _BLOCK, "dict_type": _BLOCK,
    "list_type": _LIST, "tuple_type": _LIST,
}  # fmt: skip
"""What pydantic says in words of Python."""


def _words(context: dict[str, Any]) -> str:
    return str(context.get("expected_tags", "")).replace("'", "")


def shorten(given: object) -> str:
    """Returns what was given, in at most 60 characters, however large it is."""
    text = _BRIEF.repr(given)
    return text if len(text) <= 60 else text[:57] + "…"


_BRIEF = reprlib.Repr()
_BRIEF.maxlevel, _BRIEF.maxstring, _BRIEF.maxother = 3, 60, 60


def nearest(word: str, words: Sequence[str]) -> str:
    """Returns the end of a sentence: the valid word meant, or all of them."""
    close = get_close_matches(word[:100], words, n=1)
    return f"; did you mean {close[0]!r}?" if close else _known(words)


def _known(words: Sequence[str]) -> str:
    return f"; known: {', '.join(sorted(words))}" if words else ""


def untagged(model: type[BaseModel], path: Sequence[str | int]) -> yaml12.Path:
    """Returns a path of pydantic's without the tags of the unions on it: what a user would write."""
    inside: list[Any] = [model]
    steps: list[str | int] = []
    for step in path:
        if not any(_is_tag(annotation, step) for annotation in inside):
            steps.append(step)
        inside = [inner for annotation in inside for inner in _enter(annotation, step)]
    return tuple(steps)


def keys_at(model: type[BaseModel], path: Sequence[str | int]) -> list[str]:
    """Returns the keys that a model takes at a path, whose steps may be union tags."""
    inside: list[Any] = [model]
    for step in path:
        inside = [inner for annotation in inside for inner in _enter(annotation, step)]
    return [str(key) for annotation in inside for choice in _choices(annotation) for key in _fields(choice)]


def kinds_at(model: type[BaseModel], path: Sequence[str | int]) -> list[str]:
    """Returns the kinds that a block at a path may have."""
    inside: list[Any] = [model]
    for step in path:
        inside = [inner for annotation in inside for inner in _enter(annotation, step)]
    return [str(tag) for annotation in inside for choice in _choices(annotation) for tag in _tags(choice)]


def _enter(annotation: Any, step: str | int) -> Iterator[Any]:
    """Yields the annotations one step further in: a field's, an item's, or a union's choice by its tag."""
    by_tag = _is_tag(annotation, step)
    for choice in _choices(annotation):
        if get_origin(choice) in (list, tuple, dict):
            yield get_args(choice)[-1]
        elif by_tag and step in _tags(choice):
            yield choice
        elif not by_tag and step in _fields(choice):
            yield _fields(choice)[step]


def _is_tag(annotation: Any, step: str | int) -> bool:
    """Tells whether a step is the kind that a union's choice is told by; it may be a field's name as well."""
    tags = [_tags(choice) for choice in _choices(annotation)]
    return sum(map(bool, tags)) > 1 and any(step in of for of in tags)


def _choices(annotation: Any) -> Iterator[Any]:
    """Yields what an annotation may be: itself, or each member of a union."""
    if get_origin(annotation) is Annotated:
        yield from _choices(get_args(annotation)[0])
    elif get_origin(annotation) in (Union, types.UnionType):
        for choice in get_args(annotation):
            yield from _choices(choice)
    else:
        yield annotation


def _fields(model: Any) -> dict[str | int, Any]:
    if not (isinstance(model, type) and issubclass(model, BaseModel)):
        return {}
    return {field.alias or name: field.annotation for name, field in model.model_fields.items()}


def _tags(model: Any) -> tuple[Any, ...]:
    kind = _fields(model).get("kind")
    return get_args(kind) if get_origin(kind) is Literal else ()
