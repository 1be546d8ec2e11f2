"""A wall clock that goes on only when somebody sleeps, or is made to."""

from __future__ import annotations

from hilbed.pacer import Time


class Wall:
    """now: ns; slept: every sleep, s; each sleep takes `over` ns longer than it should."""

    def __init__(self, over: int = 0) -> None:
        self.now = 5_000_000_000
        self.slept: list[float] = []
        self.over = over

    def sleep(self, seconds: float) -> None:
        self.slept.append(seconds)
        self.now += round(seconds * 1e9) + self.over

    def time(self) -> Time:
        """Returns it as the pacer sees it."""
        return Time(lambda: self.now, self.sleep)
