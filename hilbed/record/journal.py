"""The recorder that the loop talks to: it adds what witnesses have noted and hands on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress

from hilbed.clock import SECOND
from hilbed.cost import Cost, perf_counter
from hilbed.ports import Reference
from hilbed.record.disk import RecordError
from hilbed.record.notes import Notes
from hilbed.record.row import UNKNOWN, Batch, DeadReckoning, Row, Sink, row_of
from hilbed.record.sinks import Sinks
from hilbed.types import Array, Cycle, Nanos, Pose

HELPING: Nanos = SECOND // 2


class Journal:
    """The recorder of a run in front of any number of sinks.

    Cycles and what witnesses have noted are kept for `helping` (half a second, without readings twice as
    long) and then handed on at once: in big helpings, while the caches are warm, the work takes half as
    long. Cycles are values, so nobody may write to their arrays afterwards.
    """

    def __init__(
        self,
        notes: Notes,
        sinks: Sequence[Sink],
        cost: Cost,
        start: Pose,
        reference: Reference | None = None,
        helping: Nanos = HELPING,
    ) -> None:
        """helping: ns of simulated time; in real time small ones are better, which hold up no cycle."""
        self._notes = notes
        self._sinks = Sinks(sinks)
        self._cost = cost
        self._reckoning = DeadReckoning(start)
        self._reference = reference
        self._helping = helping
        self._cycles: list[Cycle] = []
        self._ticks: list[Mapping[str, Array]] = []

    def ticks(self, rows: Mapping[str, Array]) -> None:
        """Takes the rows of the plant's tick log that are new, each (n,), for the logs; at any pace.

        A plant without drives has none.
        """
        if rows:
            self._ticks.append(rows)

    def record(self, cycle: Cycle) -> None:
        """Keeps a cycle and, once or twice a second, hands on all that was kept and noted.

        Raises RecordError when a log cannot be written; that log is closed, the others go on.
        """
        start = perf_counter()
        self._cycles.append(cycle)
        if self._due(cycle):
            self._hand_on()
        self._cost.record += perf_counter() - start

    def _due(self, cycle: Cycle) -> bool:
        """Tells whether it is time to hand on, rather with readings than without.

        A camera's process that has just answered has nothing to do, so that of the logs is not in its way on
        the processor that both may have to share.
        """
        kept = cycle.t - self._cycles[0].t
        return kept >= (self._helping if cycle.readings else 2 * self._helping)

    def close(self) -> None:
        """Hands on what is left, also of a run that was aborted, and closes every sink; not part of the cost.

        Raises RecordError, after all sinks are closed, when a log could not be finished.
        """
        try:
            self._hand_on()
        except RecordError:
            with suppress(RecordError):
                self._sinks.close()
            raise
        self._sinks.close()

    def _hand_on(self) -> None:
        notes = self._notes
        rows = [self._row(cycle) for cycle in self._cycles]
        batch = Batch(rows, notes.transfers, notes.readings, notes.snapshots, self._ticks)
        try:
            self._sinks.take(batch)
        finally:
            notes.clear()
            self._cycles.clear()
            self._ticks.clear()

    def _row(self, cycle: Cycle) -> Row:
        odometry = self._reckoning.at(cycle.t, cycle.odometry)
        reference = UNKNOWN if self._reference is None else self._reference.at(cycle.t).pose
        return row_of(cycle, odometry, reference)
