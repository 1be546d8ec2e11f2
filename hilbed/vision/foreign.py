"""A foreign detector behind the seam: asked under a deadline, judged, started again where it is lost."""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np

from hilbed.types import ScenarioError
from hilbed.vision.child import Child, ChildLost
from hilbed.vision.code import parse
from hilbed.vision.detectors import ForeignSpec
from hilbed.vision.lens import Lens
from hilbed.vision.returned import checked
from hilbed.vision.seams import Detection, DetectionFailed, Failure, Shot, Trouble, quoted

_CHILD = "hilbed.vision.foreign_child"
RESTARTS, MOST_RESTARTS = 3, 20
"""So many times in succession, without an answer in between, and in all, it is started again."""

_PLACE = re.compile(r'^  File "(?P<file>[^"]+)", line (?P<line>\d+) in (?P<function>\S+)', re.MULTILINE)


class ForeignDetector:
    """Runs somebody else's detector in a child process; what it does wrong costs a frame, never the bench.

    beacons: how many there are; anonymous: identities are taken out. A child that hangs or has died is ended
    and, with the next frame, started again. said: what it has printed for the last frame. Raises
    ScenarioError where the code cannot be loaded or its class cannot be made.
    """

    def __init__(self, spec: ForeignSpec, lens: Lens, beacons: int, anonymous: bool = False) -> None:
        self._spec, self._lens, self._beacons, self._anonymous = spec, lens, beacons, anonymous
        self.said = ""
        self._left, self._left_in_all = RESTARTS, MOST_RESTARTS
        self._child: Child | None = self._start()

    @property
    def pid(self) -> int | None:
        """The child's process number, None while there is none."""
        return None if self._child is None else self._child.pid

    def detect(self, shot: Shot) -> list[Detection]:
        """Returns what it sees, from left to right; raises DetectionFailed where it has no valid answer."""
        child = self._child or self._again()
        np.copyto(child.image(shot.image.shape), shot.image)
        answer = self._ask(child, {"t": shot.t}, self._spec.deadline)
        self._left = RESTARTS
        self.said = child.said()
        found = self._judged(answer)
        return [one._replace(beacon=None) for one in found] if self._anonymous else found

    def close(self) -> None:
        """Ends the child."""
        self._end()

    def _judged(self, answer: dict[str, Any]) -> list[Detection]:
        if "raised" in answer:
            raise failed("raised", str(answer["raised"]), self.said)
        if "invalid" in answer:
            raise failed("invalid", str(answer["invalid"]), self.said)
        try:
            return checked(answer["rows"], self._lens, self._beacons)
        except ValueError as error:
            raise failed("invalid", str(error), self.said) from None
        except (KeyError, TypeError):
            raise failed("died", "its process wrote garbage on the bench's line", self.said) from None

    def _start(self) -> Child:
        """Starts the child and waits until its detector is made; raises ScenarioError."""
        spec, lens = self._spec, self._lens
        child = Child(_CHILD, lens.height * lens.width * 3, (parse(spec.code), dict(spec.options), lens))
        self._child = child
        try:
            answer = child.answer(spec.startup)
        except TimeoutError:
            text = f"is not made within its startup of {spec.startup:g} s{_where(child.traceback())}"
        except ChildLost as error:
            text = f"{error} before it was made"
        else:
            if "ready" in answer:
                return child
            text = str(answer.get("refused", "gave no sensible answer"))
        said = child.said()
        self._end()
        raise ScenarioError(f"detector {spec.code}: {text}{quoted(said)}")

    def _again(self) -> Child:
        if not (self._left and self._left_in_all):
            raise failed("skipped", "not asked any more: it was started again often enough")
        self._left -= 1
        self._left_in_all -= 1
        try:
            return self._start()
        except ScenarioError as error:
            raise failed("died", f"cannot be started again: {error}") from None

    def _ask(self, child: Child, request: dict[str, Any], deadline: float) -> dict[str, Any]:
        try:
            child.send(json.dumps(request).encode() + b"\n")
            return child.answer(deadline)
        except TimeoutError:
            where = _where(child.traceback())
            failure = failed("late", f"missed its deadline of {deadline:g} s{where}", child.said())
        except ChildLost as error:
            said, _, fatal = child.said().partition("Fatal Python error")
            failure = failed("died", f"{error}{_where(fatal)}", said)
        self._end()
        raise failure

    def _end(self) -> None:
        if self._child is not None:
            self._child.close()
            self._child = None


def failed(failure: Failure, text: str, said: str = "") -> DetectionFailed:
    """Returns what is raised for a frame without an answer."""
    return DetectionFailed(Trouble(failure, text, said))


def _where(traceback: str) -> str:
    """Returns the place that a traceback of `faulthandler` names: the innermost that is not a library's."""
    places = list(_PLACE.finditer(traceback))
    own = [place for place in places if "/lib/python" not in place["file"]] or places
    return f" at {own[0]['file']}:{own[0]['line']} in {own[0]['function']}" if own else ""
