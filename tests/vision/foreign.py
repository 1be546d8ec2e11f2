"""Somebody else's detectors, good ones and bad ones, as a test writes them to a file."""

from __future__ import annotations

from pathlib import Path

CODE = '''\
import os, sys, time

class Fixed:
    """Sees what its options say."""

    def __init__(self, azimuth=0.1, column=100.0, beacon=1):
        self.row = (azimuth, 1e-3, column, beacon)

    def detect(self, shot):
        return [self.row]

class Looks:
    """Tells what it was given."""

    def detect(self, shot):
        assert shot.image.shape == (64, 640, 3) and shot.image.flags.writeable
        bright = int(shot.image.max())
        return [{"azimuth": shot.lens.azimuth(bright), "std": 1e-9 * shot.t, "column": bright, "row": 7}]

class Raises:
    def detect(self, shot):
        print("about to divide")
        return 1 / 0

class Exits:
    def detect(self, shot):
        sys.exit("enough")

class Hangs:
    """Hangs with every second frame that it is shown."""

    def __init__(self):
        self.shown = 0

    def detect(self, shot):
        self.shown += 1
        while self.shown % 2 == 0:
            pass
        return [(0.1, 1e-3, 100.0)]

class Sleeps:
    def detect(self, shot):
        print("good night", flush=True)
        time.sleep(1000)

class Dies:
    def detect(self, shot):
        sys.stderr.write("last words")
        os._exit(7)

class Crashes:
    def detect(self, shot):
        import ctypes
        ctypes.string_at(0)

class Garbage:
    """Writes on whatever is open."""

    def detect(self, shot):
        for number in range(3, 1024):
            try:
                os.write(number, b"no JSON\\n")
            except OSError:
                pass
        return []

class Chatters:
    def detect(self, shot):
        print("x" * 1_000_000)
        return []

class Returns:
    def __init__(self, what):
        self.what = what

    def detect(self, shot):
        return eval(self.what)

class Slow:
    def __init__(self):
        time.sleep(1000)

    def detect(self, shot):
        return []

class Broken:
    def __init__(self):
        raise RuntimeError("no weights")

    def detect(self, shot):
        return []

class Blind:
    pass

number = 3
'''


def line(statement: str) -> int:
    """Returns the line of the code that holds a statement."""
    return next(k for k, text in enumerate(CODE.splitlines(), 1) if statement in text)


def write(folder: Path) -> Path:
    path = folder / "eyes.py"
    path.write_text(CODE)
    return path
