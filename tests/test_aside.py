"""Where processes that work for the bench run."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

from hilbed.aside import Aside


@pytest.fixture
def processors() -> Iterator[set[int]]:
    """Those of this process, which has them again afterwards."""
    given = os.sched_getaffinity(0)
    yield given
    os.sched_setaffinity(0, given)


def test_keeps_off_the_one_that_the_bench_runs_on(processors: set[int]) -> None:
    Aside(os.getpid()).step()
    left = os.sched_getaffinity(0)
    assert left < processors or len(processors) == 1
    assert len(left) == max(1, len(processors) - 1)


def test_stays_where_it_is_when_the_bench_has_gone(processors: set[int]) -> None:
    child = os.posix_spawnp("true", ["true"], os.environ)
    aside = Aside(child)
    os.waitpid(child, 0)
    aside.step()
    Aside(child).step()
    assert os.sched_getaffinity(0) == processors
