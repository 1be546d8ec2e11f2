from __future__ import annotations

import pytest

from hilbed.cost import Cost
from hilbed.ports import Recorder, Witness
from hilbed.record.disk import RecordError
from hilbed.record.journal import Journal
from hilbed.record.notes import Notes
from hilbed.record.row import Batch
from hilbed.types import Pose
from tests.record.runs import cycle, transfer


class Counting:
    def __init__(self, fail_at: int | None = None) -> None:
        self.rows = self.frames = self.closed = 0
        self.fail_at = fail_at

    def take(self, batch: Batch) -> None:
        self.rows += batch.row is not None
        self.frames += len(batch.transfers)
        if self.rows == self.fail_at:
            raise RecordError("disk full")

    def close(self) -> None:
        self.closed += 1


def test_what_witnesses_note_reaches_the_sinks_with_the_cycle_and_is_paid_for() -> None:
    cost, sink = Cost(), Counting()
    notes = Notes()
    journal = Journal(notes, [sink], cost, Pose(0.0, 0.0, 0.0))
    recorder: Recorder = journal
    witness: Witness = notes
    witness.transfer(transfer(0, 1))
    recorder.record(cycle(0))
    witness.transfer(transfer(1, 1))
    assert (sink.rows, sink.frames) == (1, 1)
    assert cost.record > 0
    journal.close()
    assert (sink.rows, sink.frames, sink.closed) == (1, 2, 1)


def test_a_log_that_breaks_is_closed_and_the_others_go_on() -> None:
    good, bad = Counting(), Counting(fail_at=2)
    notes = Notes()
    journal = Journal(notes, [bad, good], Cost(), Pose(0.0, 0.0, 0.0))
    journal.record(cycle(0))
    with pytest.raises(RecordError, match="disk full"):
        journal.record(cycle(1))
    journal.record(cycle(2))
    journal.close()
    assert (bad.rows, bad.closed) == (2, 1)
    assert (good.rows, good.closed) == (3, 1)
