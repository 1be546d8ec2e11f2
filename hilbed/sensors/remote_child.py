"""What runs behind a remote eye: `python -m hilbed.sensors.remote_child SOCKET MEMORY`, descriptors both."""

from __future__ import annotations

import os
import pickle
import signal
import sys
from collections.abc import Iterator
from contextlib import suppress
from mmap import mmap
from typing import IO, Any

import numpy as np

from hilbed import collector
from hilbed.aside import Aside
from hilbed.cost import Cost
from hilbed.sensors.camera import open_eye
from hilbed.sensors.parcel import made_exposure, plain_findings
from hilbed.sensors.remote import EyeLost
from hilbed.types import HilbedError, Image
from hilbed.vision.lifeline import end_with


def requests(line: IO[bytes]) -> Iterator[Any]:
    """Yields what the bench asks for until it has gone."""
    with suppress(EOFError, OSError):
        while True:
            yield pickle.load(line)


def answers(asked: Iterator[Any], shared: Image) -> Iterator[object]:
    """Yields an answer to each request; an error is an answer, too, and the last one."""
    try:
        yield from frames(asked, shared)
    except HilbedError as error:
        yield error
    except Exception as error:
        yield EyeLost(f"the camera's own process has failed: {error!r}")


def frames(asked: Iterator[Any], shared: Image) -> Iterator[object]:
    """Yields None when the eye is ready; then, with each image in `shared`, findings and seconds it took.

    asked: first spec and setting, then the exposure of each frame.
    """
    spec, setting = next(asked)
    cost = Cost()
    eye = open_eye(spec, setting, cost)
    aside = Aside(os.getppid())
    aside.step()
    yield None
    for plain in asked:
        render, vision = cost.render, cost.vision
        image, findings, *told = eye.look(made_exposure(plain))()
        np.copyto(shared.reshape(image.shape), image)
        yield plain_findings(findings), *told, cost.render - render, cost.vision - vision
        aside.step()  # while nobody waits for it


def main() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the bench decides when it is over
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    end_with(os.getppid(), signal.SIGTERM)  # even while it waits for a foreign detector
    descriptor, memory = map(int, sys.argv[1:])
    shared = np.frombuffer(mmap(memory, 0), np.uint8)
    with (
        suppress(OSError),  # the bench has gone
        open(descriptor, "rb") as asked,
        open(descriptor, "wb", closefd=False) as told,
        collector.paused(),
    ):
        for answer in answers(requests(asked), shared):
            pickle.dump(answer, told)
            told.flush()


if __name__ == "__main__":
    main()
