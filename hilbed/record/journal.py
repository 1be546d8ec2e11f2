"""The recorder that the loop talks to: it adds what witnesses have noted and hands on, once a cycle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hilbed.cost import Cost, perf_counter
from hilbed.ports import Reference
from hilbed.record.disk import RecordError
from hilbed.record.notes import Notes
from hilbed.record.row import UNKNOWN, Batch, DeadReckoning, Row, Sink
from hilbed.types import Array, Cycle, Pose


class Journal:
    """The recorder of a run in front of any number of sinks.

    What witnesses have noted reaches the sinks with the next cycle, so that the work is charged to
    `cost.record`, not to the part that reports.
    """

    def __init__(
        self,
        notes: Notes,
        sinks: Sequence[Sink],
        cost: Cost,
        start: Pose,
        reference: Reference | None = None,
    ) -> None:
        self._notes = notes
        self._sinks = list(sinks)
        self._cost = cost
        self._reckoning = DeadReckoning(start)
        self._reference = reference
        self._ticks: dict[str, Array] = {}

    def ticks(self, rows: Mapping[str, Array]) -> None:
        """Takes the rows of the plant's tick log that are new, each (n,), for the logs; at any pace."""
        self._ticks.update(rows)

    def record(self, cycle: Cycle) -> None:
        """Hands a cycle and all that was noted since the previous one to the sinks.

        Raises RecordError when a log cannot be written; that log is closed, the others go on.
        """
        start = perf_counter()
        t = cycle.t
        odometry = self._reckoning.at(t, cycle.odometry)
        reference = UNKNOWN if self._reference is None else self._reference.at(t).pose
        self._hand_on(Row(cycle, odometry, reference))
        self._cost.record += perf_counter() - start

    def close(self) -> None:
        """Hands on what is left, also of a run that was aborted, and closes every sink; not part of the cost.

        Raises RecordError, after all sinks are closed, when a log could not be finished.
        """
        problems = []
        for step in (lambda: self._hand_on(None), *(sink.close for sink in self._sinks)):
            try:
                step()
            except RecordError as error:
                problems.append(error)
        self._sinks.clear()
        if problems:
            raise problems[0]

    def _hand_on(self, row: Row | None) -> None:
        notes = self._notes
        batch = Batch(row, notes.transfers, notes.readings, notes.snapshots, self._ticks)
        broken: list[tuple[Sink, RecordError]] = []
        for sink in self._sinks:
            try:
                sink.take(batch)
            except RecordError as error:
                broken.append((sink, error))
        notes.clear()
        self._ticks.clear()
        for sink, _ in broken:
            self._drop(sink)
        if broken:
            raise broken[0][1]

    def _drop(self, sink: Sink) -> None:
        """Closes a sink that failed: what it has written stays readable."""
        self._sinks.remove(sink)
        try:
            sink.close()
        except RecordError:
            return  # the same trouble, already told
