"""Several sinks as one: what goes wrong with one of them does not keep the others from going on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from hilbed.record.disk import RecordError
from hilbed.record.row import Batch, Sink


class Sinks:
    """A sink in front of any number of others."""

    def __init__(self, sinks: Sequence[Sink]) -> None:
        self._sinks = list(sinks)

    def take(self, batch: Batch) -> None:
        """Hands a batch to each; raises RecordError when one cannot write it: that one is closed."""
        troubles = [_trouble(partial(sink.take, batch)) for sink in self._sinks]
        for sink, trouble in zip(tuple(self._sinks), troubles, strict=True):
            if trouble is not None:
                self._sinks.remove(sink)
                _trouble(sink.close)  # what it has written stays readable
        _tell(troubles)

    def close(self) -> None:
        """Closes all; raises RecordError, after that, when one could not be finished."""
        troubles = [_trouble(sink.close) for sink in self._sinks]
        self._sinks.clear()
        _tell(troubles)


def _trouble(step: Callable[[], None]) -> RecordError | None:
    """Does a step and returns what went wrong on the disk, so that the steps after it are done, too."""
    try:
        step()
    except RecordError as error:
        return error
    return None


def _tell(troubles: Sequence[RecordError | None]) -> None:
    for trouble in troubles:
        if trouble is not None:
            raise trouble
