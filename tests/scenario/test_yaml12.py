"""Scenario files mean what YAML 1.2 says, and every value knows its line."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hilbed import yaml12
from hilbed.types import ScenarioError


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("1e3", 1000.0), ("1e-05", 1e-5), ("010", 10), ("0x10", 16), ("on", "on"), ("yes", "yes"),
        ("true", True), ("~", None), ("1.", 1.0), (".5", 0.5), ("-.inf", float("-inf")), ("12:30", "12:30"),
        ("1_000", "1_000"), ("[1, 2.5]", [1, 2.5]),
    ],
)  # fmt: skip
def test_scalars(text: str, meant: object) -> None:
    value = yaml12.value(text)
    assert value == meant
    assert type(value) is type(meant)


scalars = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text()


@given(st.dictionaries(st.text(min_size=1), st.recursive(scalars, st.lists, max_leaves=5)))
def test_what_is_written_is_read_back(data: dict[str, object]) -> None:
    assert yaml12.read(yaml12.write(data), "x")[0] == data


def test_lines_of_values_and_of_blocks_that_lack_them() -> None:
    _, marks = yaml12.read("a: 1\nb:\n  c: 2\n  d:\n    - x\n    - y\n", "x")
    assert [marks.line(path) for path in (("a",), ("b", "c"), ("b", "d", 1), ("b", "missing"))] == [
        1,
        3,
        6,
        2,
    ]


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("a: 1\na: 2\n", 2),
        ("a: [1\n", 2),
        ("a: !!python/object:os.system x\n", 1),
        ("- 1\n", 1),
        ("a: b: c\n", 1),
        ("a: 1\n? [b, c]\n: 1\n", 2),
        ("a: 1\n? {b: c}\n: 1\n", 2),
        (f"a: 1\nb: 0x{'f' * 5000}\n", 2),
        (f"a: {'9' * 5000}\n", 1),
    ],
)
def test_what_cannot_be_read_names_its_line(text: str, line: int) -> None:
    with pytest.raises(ScenarioError, match=f"^file.yaml:{line}: "):
        yaml12.read(text, "file.yaml")


@pytest.mark.parametrize("text", ["a: " + "[" * 5000, "a: " + "[" * 3000 + "]" * 3000, "a: " + "{b: " * 3000])
def test_deep_nesting_is_refused(text: str) -> None:
    with pytest.raises(ScenarioError, match=r"^file.yaml:"):
        yaml12.read(text, "file.yaml")
