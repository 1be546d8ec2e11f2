"""YAML 1.2 as people mean it: `1e3` is a number, `on` a word, `010` ten; and every value knows its line."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, TypeAlias

import yaml

from hilbed.types import ScenarioError

Path: TypeAlias = tuple[str | int, ...]

LARGEST = 1_000_000
"""Characters; a scenario is some hundred lines, so more than this is a mistake."""

LONGEST_NUMBER = 100
"""Digits of a whole number."""


class _Loader(yaml.SafeLoader):
    """SafeLoader with the resolvers of the YAML 1.2 core schema and no duplicate keys."""

    yaml_implicit_resolvers: dict[str, list[tuple[str, re.Pattern[str]]]] = {}


def _integer(loader: _Loader, node: yaml.ScalarNode) -> int:
    text = loader.construct_scalar(node)
    if len(text) > LONGEST_NUMBER:
        raise yaml.MarkedYAMLError(problem=f"a number of {len(text)} digits", problem_mark=node.start_mark)
    return int(text, 0) if text[:2] in ("0x", "0o") else int(text)


def _number(loader: _Loader, node: yaml.ScalarNode) -> float:
    text = loader.construct_scalar(node).lower()
    return float(text.replace(".inf", "inf").replace(".nan", "nan"))


def _mapping(loader: _Loader, node: yaml.MappingNode) -> dict[Any, Any]:
    seen: dict[str, int] = {}
    for key, _ in node.value:
        line = key.start_mark.line + 1
        if not isinstance(key, yaml.ScalarNode):
            raise yaml.MarkedYAMLError(problem="a key is a single word", problem_mark=key.start_mark)
        if key.value in seen:
            raise yaml.MarkedYAMLError(
                problem=f"key {key.value!r} stands here and in line {seen[key.value]}; keep one",
                problem_mark=key.start_mark,
            )
        seen[key.value] = line
    return loader.construct_mapping(node, deep=True)


_RESOLVERS = (
    ("null", r"~|null|Null|NULL|", "~nN\0"),
    ("bool", r"true|True|TRUE|false|False|FALSE", "tTfF"),
    ("int", r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+", "-+0123456789"),
    (
        "float",
        r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)",
        "-+.0123456789",
    ),
)
for _tag, _pattern, _first in _RESOLVERS:
    _Loader.add_implicit_resolver(f"tag:yaml.org,2002:{_tag}", re.compile(f"^(?:{_pattern})$"), [*_first, ""])
_Loader.add_constructor("tag:yaml.org,2002:int", _integer)
_Loader.add_constructor("tag:yaml.org,2002:float", _number)
_Loader.add_constructor("tag:yaml.org,2002:map", _mapping)


class Marks:
    """Where each value of a document stands."""

    def __init__(self, root: yaml.Node | None) -> None:
        self._root = root

    def line(self, path: Sequence[str | int]) -> int:
        """Returns the line (from 1) of the value at `path`, or of the deepest part of it that exists."""
        node, line = self._root, 1
        for step in path:
            found = _child(node, step)
            if found is None:
                break  # a key that is missing: its block is what can be shown
            node, line = found
        return line

    def hold(self, path: Sequence[str | int]) -> bool:
        """Tells whether there is a value at `path`."""
        node = self._root
        for step in path:
            found = _child(node, step)
            if found is None:
                return False
            node, _ = found
        return True


def _child(node: yaml.Node | None, step: str | int) -> tuple[yaml.Node, int] | None:
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            if key.value == str(step):
                return value, key.start_mark.line + 1
    if isinstance(node, yaml.SequenceNode) and isinstance(step, int) and step < len(node.value):
        return node.value[step], node.value[step].start_mark.line + 1
    return None


def read(text: str, name: str) -> tuple[dict[str, Any], Marks]:
    """Parses one document that must be a mapping; `name` is what errors call it.

    Raises ScenarioError with name and line.
    """
    if len(text) > LARGEST:
        raise ScenarioError(f"{name}: {len(text)} characters, a file has at most {LARGEST}")
    try:
        loader = _Loader(text)
        root = loader.get_single_node()
        data = None if root is None else loader.construct_document(root)
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 1
        raise ScenarioError(f"{name}:{line}: {error.problem or 'not YAML'}") from None
    except RecursionError:
        raise ScenarioError(f"{name}: nested too deeply") from None
    except (yaml.YAMLError, ValueError) as error:
        raise ScenarioError(f"{name}: not YAML: {error}") from None
    if not isinstance(data, dict):
        raise ScenarioError(
            f"{name}:1: this should be a mapping of keys to values, not {type(data).__name__}"
        )
    return data, Marks(root)


def value(text: str) -> Any:
    """Parses the VALUE of `--set PATH=VALUE`; raises ScenarioError."""
    try:
        return yaml.load(text, _Loader)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        why = error.problem if isinstance(error, yaml.MarkedYAMLError) else error
        raise ScenarioError(f"{text!r} is not a YAML value: {why}") from None


class _Dumper(yaml.SafeDumper):
    """Writes what `_Loader` reads back: floats always with a point, so that 1e-05 stays a number."""

    def ignore_aliases(self, _: Any) -> bool:
        return True


def _represent_float(dumper: yaml.SafeDumper, number: float) -> yaml.ScalarNode:
    text = repr(number)
    if text in ("inf", "-inf", "nan"):
        text = text.replace("inf", ".inf").replace("nan", ".nan")
    return dumper.represent_scalar("tag:yaml.org,2002:float", text)


_Dumper.add_representer(float, _represent_float)
_Dumper.yaml_implicit_resolvers = _Loader.yaml_implicit_resolvers


def write(data: dict[str, Any]) -> str:
    """Writes a mapping so that `read` gives it back."""
    return str(yaml.dump(data, Dumper=_Dumper, sort_keys=False, default_flow_style=None, width=110))
