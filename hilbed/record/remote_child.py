"""What runs behind remote logs: `python -m hilbed.record.remote_child`, a plan and batches on standard input.

A line of JSON on standard output answers each: the seconds that it took, and what went wrong or null.
"""

from __future__ import annotations

import json
import os
import pickle
import signal
import sys
from collections.abc import Callable, Iterator
from functools import partial
from typing import IO

from hilbed.aside import Aside
from hilbed.collector import paused
from hilbed.cost import perf_counter
from hilbed.record.disk import RecordError
from hilbed.record.logs import open_logs
from hilbed.record.parcel import receive
from hilbed.record.row import Sink
from hilbed.record.sinks import Sinks

Answer = tuple[float, str | None]


def answers(stream: IO[bytes]) -> Iterator[Answer]:
    """Writes what comes in until there is no more, then ends the logs; yields an answer to each step."""
    aside, opened = Aside(os.getppid()), list[Sink]()
    yield done(lambda: opened.extend(open_logs(pickle.load(stream))))
    logs = Sinks(opened)
    while (batch := receive(stream)) is not None:
        aside.step()
        yield done(partial(logs.take, batch))
    yield done(logs.close)


def done(step: Callable[[], None]) -> Answer:
    """Does a step; returns how long it took (s), and what went wrong if anything did."""
    start, trouble = perf_counter(), None
    try:
        step()
    except RecordError as error:
        trouble = str(error)
    except Exception as error:
        trouble = f"the process for the logs has failed: {error!r}"
    return perf_counter() - start, trouble


def main() -> None:
    for number in (signal.SIGINT, signal.SIGTERM):  # it ends when the bench has ended and all is written
        signal.signal(number, signal.SIG_IGN)
    with paused():
        for answer in answers(sys.stdin.buffer):
            try:
                print(json.dumps(answer), flush=True)
            except BrokenPipeError:  # nobody is left to hear it
                os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


if __name__ == "__main__":
    main()
