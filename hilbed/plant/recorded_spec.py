"""Scenario block of a recorded robot."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from hilbed.spec import Finite, Listed, NonNegative, Positive, Spec


class RecordedSpec(Spec):
    """Plays a file (format: module `recording`).

    start, length (s): which part of it, null for all that is left; azimuth, range: which readings are
    used; max_range (m): beacons farther away are left out where the file knows ranges; azimuth_std (rad),
    range_std (m): what readings say of themselves, null for the file's variances; anonymous: readings do
    not say whose they are; pose (m, m, rad): the start as the estimator is told it, null for the truth.
    """

    kind: Literal["recorded"]
    file: str
    start: NonNegative = 0.0
    length: Positive | None = None
    azimuth: bool = True
    range: bool = False
    max_range: Positive | None = None
    azimuth_std: Positive | None = None
    range_std: Positive | None = None
    anonymous: bool = False
    pose: Listed[tuple[Finite, Finite, Annotated[float, Field(ge=-3.2, le=3.2)]]] | None = None

    def kinds(self) -> list[str]:
        """Returns the kinds of readings that are used."""
        return [kind for kind, used in (("azimuth", self.azimuth), ("range", self.range)) if used]
