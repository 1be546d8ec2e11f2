"""Bullet's OpenGL renderer, which ends the process where it does not work: so a child tries it first."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import CDLL
from functools import cache
from importlib.util import find_spec
from os import O_WRONLY, close, devnull, dup, dup2, open

from hilbed.types import ScenarioError
from hilbed.vision.opengl import Pinhole

LARGEST_FRAME = (1024, 768)
_PATIENCE = 60.0


@cache
def trouble() -> str:
    """Returns why EGL cannot be used on this machine, empty where it can."""
    try:
        child = subprocess.run([sys.executable, "-m", __name__], capture_output=True, timeout=_PATIENCE)
    except subprocess.TimeoutExpired:
        return f"no frame within {_PATIENCE:g} s"
    return "" if child.returncode == 0 else f"a trial in a child process ended with {child.returncode}"


def require(lens: Pinhole) -> None:
    """Raises ScenarioError where EGL does not work or cannot draw as large a frame."""
    width, height = LARGEST_FRAME
    if lens.width > width or lens.height > height:
        raise ScenarioError(
            f"the camera's renderer egl draws at most {width}×{height} pixels, "
            f"not {lens.width}×{lens.height}; renderer: tiny draws any size"
        )
    if trouble():
        raise ScenarioError(f"the camera's renderer egl does not work here ({trouble()}); use renderer: tiny")


_open: set[int] = set()
_closed: list[int] = []


def load(client: int) -> None:
    """Makes EGL draw for both of Bullet's renderer constants in one client, until it is released."""
    import pybullet

    spec = find_spec("eglRenderer")
    if spec is None or spec.origin is None:
        raise ScenarioError("this build of PyBullet has no EGL renderer; use renderer: tiny")
    with silence():
        plugin = pybullet.loadPlugin(spec.origin, "_eglRendererPlugin", physicsClientId=client)
    if plugin < 0:
        raise ScenarioError("PyBullet did not load its EGL renderer; use renderer: tiny")
    _open.add(client)


def release(client: int) -> None:
    """Disconnects a client as soon as no other draws: a client that goes takes the context of all with it."""
    import pybullet

    _open.discard(client)
    _closed.append(client)
    if not _open:
        with silence():
            while _closed:
                pybullet.disconnect(_closed.pop())


@contextmanager
def silence() -> Iterator[None]:
    """Keeps what C code writes off standard output, which belongs to the bench."""
    flush = CDLL(None).fflush
    sys.stdout.flush()
    flush(None)
    kept, void = dup(1), open(devnull, O_WRONLY)
    dup2(void, 1)
    try:
        yield
    finally:
        flush(None)
        dup2(kept, 1)
        close(kept)
        close(void)


def _trial() -> None:
    import pybullet

    client = pybullet.connect(pybullet.DIRECT)
    load(client)
    pybullet.getCameraImage(16, 16, physicsClientId=client)
    pybullet.disconnect(client)


if __name__ == "__main__":
    _trial()
