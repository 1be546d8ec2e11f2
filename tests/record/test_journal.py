from __future__ import annotations

from itertools import pairwise

import pytest

from hilbed.cost import Cost
from hilbed.ports import Witness
from hilbed.record.disk import RecordError
from hilbed.record.journal import Journal
from hilbed.record.notes import Notes
from hilbed.record.row import Batch, Sink
from hilbed.types import Pose
from tests.record.runs import cycle, transfer


class Counting:
    def __init__(self, fail_at: int | None = None) -> None:
        self.rows = self.frames = self.taken = self.closed = 0
        self.fail_at = fail_at

    def take(self, batch: Batch) -> None:
        self.taken += 1
        self.rows += len(batch.rows)
        self.frames += len(batch.transfers)
        if self.taken == self.fail_at:
            raise RecordError("disk full")

    def close(self) -> None:
        self.closed += 1


def journal_of(notes: Notes, *sinks: Sink, cost: Cost | None = None) -> Journal:
    return Journal(notes, sinks, cost or Cost(), Pose(0.0, 0.0, 0.0))


def test_cycles_and_notes_reach_the_sinks_once_or_twice_a_second_and_at_the_end() -> None:
    """After half a second with readings, which cycles 50 and 110 have, or after a second without."""
    cost, notes, sink = Cost(), Notes(), Counting()
    journal = journal_of(notes, sink, cost=cost)
    witness: Witness = notes
    seen = []
    for k in range(230):
        witness.transfer(transfer(k, 1))
        journal.record(cycle(k) if k < 120 else cycle(k)._replace(readings=[]))
        seen.append((sink.rows, sink.frames))
    handed = [k for k, (before, now) in enumerate(pairwise([(0, 0), *seen])) if now != before]
    assert handed == [50, 110, 211]
    assert seen[-1] == (212, 212)
    assert cost.record > 0
    journal.close()
    assert (sink.rows, sink.frames, sink.closed) == (230, 230, 1)


def test_a_log_that_breaks_is_closed_and_the_others_go_on() -> None:
    good, bad = Counting(), Counting(fail_at=2)
    journal = journal_of(Notes(), bad, good)
    for k in range(110):
        journal.record(cycle(k))
    with pytest.raises(RecordError, match="disk full"):
        journal.record(cycle(110))
    journal.record(cycle(111))
    journal.close()
    assert (bad.rows, bad.closed) == (111, 1)
    assert (good.rows, good.closed) == (112, 1)


def test_a_log_that_breaks_at_the_end_is_told_when_all_are_closed() -> None:
    good, bad = Counting(), Counting(fail_at=1)
    journal = journal_of(Notes(), bad, good)
    journal.record(cycle(0))
    with pytest.raises(RecordError, match="disk full"):
        journal.close()
    assert (good.rows, good.closed, bad.closed) == (1, 1, 1)
