"""One landmark's observer on the clock: bearings come late and now and then, odometry all the time."""

from __future__ import annotations

from math import nan

from hilbed.angles import wrap
from hilbed.estimation.bearing_observers import Observer, State
from hilbed.estimation.bearing_travel import Leg, travelled
from hilbed.estimation.ways import Way, split
from hilbed.types import Nanos


class Track:
    """Integrates an observer from exposure to exposure, φ straight in between; beyond, odometry carries it.

    `now`: state at the end of the way told so far, None until the landmark has been seen.
    """

    def __init__(self, observer: Observer, guess: float, step: float, memory: Nanos) -> None:
        """guess: of the distance (m); step (m) of integration; memory: how much of the way is kept."""
        self.now: State | None = None
        self._observer = observer
        self._guess = guess
        self._step = step
        self._memory = memory
        self._since: list[Way] = []  # the last exposure
        self._state: State = ()
        self._seen: tuple[Nanos, float | None] = (-1, None)

    def move(self, way: Way) -> None:
        """Takes the next increment."""
        self._since.append(way)
        if self.now is not None:
            self.now = self.ahead(way.distance, way.turn)
        while self._since[0].end < way.end - self._memory:
            self._forget(self._since.pop(0))

    def ahead(self, distance: float, turn: float) -> State:
        """Returns the state further on (m, rad) without keeping it; the landmark must have been seen."""
        assert self.now is not None
        return travelled(self._observer, self.now, Leg(distance, turn), self._step)

    def measured(self) -> float:
        """Returns the last measured φ as odometry has carried it (rad)."""
        assert self.now is not None
        last = self._seen[1]
        return self.now[1] if last is None else wrap(last + self.now[1] - self._state[1])

    def measure(self, t: Nanos, phi: float) -> float | None:
        """Takes φ exposed at `t`, not after the way told; returns the NIS (NaN where the observer has none).

        None, and nothing taken, where it is not newer than the last or older than the memory.
        """
        if t <= self._seen[0] or (self._since and t < self._since[0].start):
            return None
        before, after = split(self._since, t)
        if self.now is None:
            state, nis = self._observer.start(self._guess, phi), nan
        else:
            state = self._through(before, t, phi)
            nis = self._observer.nis(state, phi)
            state = self._observer.corrected(state, phi)
        self._state, self._seen, self._since = state, (t, phi), after
        self.now = state
        for way in after:
            self.now = self.ahead(way.distance, way.turn)
        return nis

    def _through(self, ways: list[Way], t: Nanos, phi: float) -> State:
        """Returns the state at the exposure `t` from that at the one before."""
        state, (t0, last) = self._state, self._seen
        for start, end, distance, turn in ways:
            between = None
            if last is not None:
                rate = wrap(phi - last) / (t - t0)
                between = last + rate * (start - t0), last + rate * (end - t0)
            state = travelled(self._observer, state, Leg(distance, turn, between), self._step)
        return state

    def _forget(self, way: Way) -> None:
        """Carries the kept state over a way too old to be measured in."""
        if self.now is not None:
            self._state = travelled(self._observer, self._state, Leg(way.distance, way.turn), self._step)
            self._seen = way.end, None
