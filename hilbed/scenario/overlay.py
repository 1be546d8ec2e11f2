"""`--set PATH=VALUE`: one value laid over the scenario by its dotted path."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from hilbed import yaml12
from hilbed.problems import shorten
from hilbed.types import ScenarioError


def apply(data: dict[str, Any], setting: str) -> yaml12.Path:
    """Changes `data` by one `PATH=VALUE` and returns the path; list items go by their index.

    A word on the way, as in `estimator: ekf`, is short for a block of that kind. Raises ScenarioError.
    """
    dotted, equals, text = setting.partition("=")
    if not equals or not dotted:
        raise ScenarioError(f"--set {setting}: give PATH=VALUE, such as duration=10 or sensors.camera.rate=5")
    path = tuple(int(step) if step.isdecimal() else step for step in dotted.split("."))
    inner: Any = data
    for step, following in pairwise(path):
        inner = _enter(inner, step, following, setting)
    try:
        value = yaml12.value(text)
    except ScenarioError as error:
        raise ScenarioError(f"--set {dotted}: {error}") from None
    _put(inner, path[-1], value, setting)
    return path


def _enter(block: Any, step: str | int, following: str | int, setting: str) -> Any:
    if isinstance(block, list):
        _check_index(block, step, setting)
        step = int(step)
        held = block[step]
    else:
        held = block.get(step)
    if isinstance(held, str) and not isinstance(following, int):
        block[step] = {"kind": held}
    elif held is None:
        block[step] = {}
    elif not isinstance(held, dict | list):
        given = shorten(held)
        raise ScenarioError(f"--set {setting}: {step} is {given}, there is nothing inside it to set")
    else:
        block[step] = held.copy()  # an anchor may have put the same block elsewhere, too
    return block[step]


def _put(block: Any, step: str | int, value: Any, setting: str) -> None:
    if isinstance(block, list):
        _check_index(block, step, setting)
        block[int(step)] = value
    else:
        block[step] = value


def _check_index(items: list[Any], step: str | int, setting: str) -> None:
    if not isinstance(step, int) or step >= len(items):
        raise ScenarioError(f"--set {setting}: {step} is not one of the list's indices 0 … {len(items) - 1}")
