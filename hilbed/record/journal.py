"""The recorder that the loop, the sensors and the bus talk to: it collects and hands on, once a cycle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hilbed.cost import Cost, perf_counter
from hilbed.ports import Reference
from hilbed.record.disk import RecordError
from hilbed.record.row import UNKNOWN, Batch, DeadReckoning, Row, Sink, Witnessed
from hilbed.types import Array, Cycle, Pose, Reading, Snapshot, Transfer


class Journal:
    """Recorder and Witness in front of any number of sinks.

    What a witness reports is only put on a list and reaches the sinks with the next cycle: reporting costs
    a tenth of a microsecond, and the work is charged to `cost.record`, not to the part that reports.
    """

    def __init__(
        self, sinks: Sequence[Sink], cost: Cost, start: Pose, reference: Reference | None = None
    ) -> None:
        self._sinks = list(sinks)
        self._cost = cost
        self._reckoning = DeadReckoning(start)
        self._reference = reference
        self._transfers: list[Transfer] = []
        self._readings: list[Witnessed] = []
        self._snapshots: list[Snapshot] = []
        self._ticks: dict[str, Array] = {}

    def transfer(self, transfer: Transfer) -> None:
        """Notes a frame that has crossed the bus."""
        self._transfers.append(transfer)

    def reading(self, reading: Reading, beacon: int, true: tuple[float, ...]) -> None:
        """Notes a reading with its true beacon (−1: spurious) and true value (NaN: none)."""
        self._readings.append(Witnessed(reading, beacon, true))

    def snapshot(self, snapshot: Snapshot) -> None:
        """Notes an exposed camera frame; its image must not be written to afterwards."""
        self._snapshots.append(snapshot)

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
        batch = Batch(row, self._transfers, self._readings, self._snapshots, self._ticks)
        broken: list[tuple[Sink, RecordError]] = []
        for sink in self._sinks:
            try:
                sink.take(batch)
            except RecordError as error:
                broken.append((sink, error))
        self._transfers.clear()
        self._readings.clear()
        self._snapshots.clear()
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
