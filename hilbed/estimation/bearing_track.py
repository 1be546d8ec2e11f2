"""One landmark's observer on the clock: bearings come late and now and then, odometry all the time."""

from __future__ import annotations

from math import nan, sin

from hilbed.angles import wrap
from hilbed.estimation.bearing_observers import AXIS, FARTHEST, NEAREST, Observer, State
from hilbed.estimation.bearing_travel import Leg, travelled
from hilbed.estimation.ways import Way, split
from hilbed.types import Nanos


class Track:
    """An observer integrated from exposure to exposure, φ straight in between; then carried by odometry.

    `singular` counts measurements with the landmark on the robot's axis, which hardly tell its distance;
    `held` those at which the distance was at its least or largest; `restarted` those before which the
    covariance was not positive, and was that of the start afterwards.
    """

    def __init__(self, observer: Observer, guess: float, step: float, memory: Nanos) -> None:
        """guess: of the distance (m); step (m) of integration; memory: how much of the way is kept."""
        self._observer = observer
        self._guess = guess
        self._step = step
        self._memory = memory
        self._since: list[Way] = []  # the last exposure
        self._state: State | None = None  # at the last exposure
        self._ahead: State = ()  # further on, after so many ways since
        self._carried = 0
        self._seen: tuple[Nanos, float | None] = (-1, None)
        self.singular = self.held = self.restarted = 0

    @property
    def now(self) -> State | None:
        """The state at the end of the way told so far, None until the landmark has been seen."""
        if self._state is None:
            return None
        for way in self._since[self._carried :]:
            self._ahead = self._carry(self._ahead, way.distance, way.turn)
        self._carried = len(self._since)
        return self._ahead

    def move(self, way: Way) -> None:
        """Takes the next increment."""
        self._since.append(way)
        while self._since[0].end < way.end - self._memory:
            self._forget(self._since.pop(0))

    def ahead(self, distance: float, turn: float) -> State:
        """Returns the state further on (m, rad) without keeping it; the landmark must have been seen."""
        now = self.now
        assert now is not None
        return self._carry(now, distance, turn)

    def measured(self) -> float:
        """Returns the last measured φ as odometry has carried it (rad)."""
        now, last = self.now, self._seen[1]
        assert now is not None
        assert self._state is not None
        return now[1] if last is None else wrap(last + now[1] - self._state[1])

    def measure(self, t: Nanos, phi: float) -> float | None:
        """Takes φ exposed at `t`, not after the way told; returns the NIS (NaN where the observer has none).

        None, and nothing taken, where it is not newer than the last or older than the memory.
        """
        if t <= self._seen[0] or (self._since and t < self._since[0].start):
            return None
        before, after = split(self._since, t)
        if self._state is None:
            state, nis = self._observer.start(self._guess, phi), nan
        else:
            state = self._checked(self._through(self._state, before, phi))
            nis = self._observer.nis(state, phi, sum(abs(way.distance) for way in before))
            state = self._observer.corrected(state, phi)
        self.singular += abs(sin(phi)) < AXIS
        self._state, self._seen, self._since = state, (t, phi), after
        self._ahead, self._carried = state, 0
        return nis

    def _checked(self, state: State) -> State:
        """Returns the state as it can be gone on from, and counts what was wrong with it."""
        sound = self._observer.sound(state)
        self.restarted += sound != state
        self.held += state[0] in (NEAREST, FARTHEST)
        return sound

    def _carry(self, state: State, distance: float, turn: float) -> State:
        return travelled(self._observer, state, Leg(distance, turn), self._step)

    def _through(self, state: State, ways: list[Way], phi: float) -> State:
        """Returns the state at an exposure from that at the one before."""
        t0, last = self._seen
        for start, end, distance, turn in ways:
            between = None
            if last is not None:
                rate = wrap(phi - last) / (ways[-1].end - t0)
                between = last + rate * (start - t0), last + rate * (end - t0)
            state = travelled(self._observer, state, Leg(distance, turn, between), self._step)
        return state

    def _forget(self, way: Way) -> None:
        """Carries the kept state over a way too old to be measured in."""
        if self._state is None:
            return
        if not self._carried:
            self._ahead = self._carry(self._ahead, way.distance, way.turn)
        self._carried = max(self._carried - 1, 0)
        self._state = self._carry(self._state, way.distance, way.turn)
        self._seen = way.end, None
