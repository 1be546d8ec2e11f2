"""The state machine is the profile's, and tests would notice if an entry of its tables were another one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

import pytest

from firmware_sim import axis, cia402
from firmware_sim.cia402 import OPTIONS, QUICK_STOPS, TRANSITIONS, Command, Ramp, State, Stop, decode
from tests.firmware import profile
from tests.firmware.specification import disagreements

RAMPS = {
    profile.COAST: Ramp.COAST,
    profile.SLOW: Ramp.SLOW,
    profile.QUICK: Ramp.QUICK,
    profile.FULL: Ramp.FULL,
}
STOPS = [Stop(ramp, end) for ramp, end in product(Ramp, State)]
PAIRS = [*product(State, Command)]


def test_the_table_of_transitions_is_the_profiles() -> None:
    assert dict(TRANSITIONS) == profile.TRANSITIONS


def test_the_table_of_quick_stops_is_the_profiles() -> None:
    wanted = {option: Stop(RAMPS[ramp], end) for option, (ramp, end) in profile.QUICK_STOP_OPTIONS.items()}
    assert dict(QUICK_STOPS) == wanted


@pytest.mark.parametrize("before", [0x0000, 0x0080])
def test_every_controlword_is_the_command_that_its_bits_say(before: int) -> None:
    for word in range(0x10000):
        assert decode(before, word) is profile.command(before, word), hex(word)


def test_the_axis_does_what_the_profile_says() -> None:
    assert list(disagreements()) == []


def mutants(table: Mapping[Any, Any], keys: list[Any], values: list[Any]) -> Iterator[tuple[Any, Any, Any]]:
    """Yields a table with one entry removed, changed or added, the key of the entry and its new value."""
    for key in keys:
        for value in values:
            if value != table.get(key):
                changed = {**table, key: value}
                yield {k: v for k, v in changed.items() if v is not None}, key, value


def survivors(
    monkeypatch: pytest.MonkeyPatch, name: str, values: list[Any], keys: list[Any]
) -> tuple[int, list[tuple[Any, Any]]]:
    """Returns how many mutants of a table there are, and those that the specification does not notice."""
    count, unnoticed = 0, []
    for table, key, value in mutants(getattr(cia402, name), keys, values):
        count += 1
        monkeypatch.setattr(axis, name, table)
        if next(disagreements(key[0] if isinstance(key, tuple) else State.ENABLED), None) is None:
            unnoticed.append((key, value))
    return count, unnoticed


@pytest.mark.sources
def test_a_wrong_transition_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever becomes of an entry the axis behaves differently, but where an added one leads nowhere.

    Out of the reaction to a fault nothing enables: that is guarded twice.
    """
    guarded = (State.REACTION, Command.ENABLE)
    count, unnoticed = survivors(monkeypatch, "TRANSITIONS", [None, *State], PAIRS)
    assert count == len(PAIRS) * len(State)
    assert all(key not in TRANSITIONS for key, _ in unnoticed)
    assert [key for key, value in unnoticed if value not in (key[0], None) and key != guarded] == []


@pytest.mark.sources
def test_a_wrong_quick_stop_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    count, unnoticed = survivors(monkeypatch, "QUICK_STOPS", [None, *STOPS], [*QUICK_STOPS])
    assert count == len(QUICK_STOPS) * len(STOPS)
    # To coast in QUICK STOP ACTIVE, where the drive has power, is to follow the ramp of that state.
    assert unnoticed == [(6, Stop(Ramp.COAST, State.QUICK_STOP))]


@pytest.mark.sources
def test_a_wrong_option_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only the options of transitions that exist; a quick stop has its own table."""
    keys = [key for key, target in TRANSITIONS.items() if target is not State.QUICK_STOP]
    objects = [0x605A, 0x605B, 0x605C, 0x605D, 0x605E]
    count, unnoticed = survivors(monkeypatch, "OPTIONS", [None, *objects], keys)
    assert (count, unnoticed) == (len(keys) * len(objects), [])
    assert set(OPTIONS) <= set(keys)


def test_a_wrong_pattern_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each of the 256 low bytes as each of the other commands."""
    right = cia402._DECODED
    wanted = [profile.command(0x80, word) for word in range(256)]
    for word, wrong in product(range(256), [None, *Command]):
        if wrong is not right[word]:
            monkeypatch.setattr(cia402, "_DECODED", (*right[:word], wrong, *right[word + 1 :]))
            assert [decode(0x80, w) for w in range(256)] != wanted
