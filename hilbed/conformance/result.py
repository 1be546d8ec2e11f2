"""What a check has found: pass, fail, not supported or not run, with the figure that was measured."""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

Status = Literal["pass", "fail", "not supported", "not run"]


class Result(NamedTuple):
    """One finding: measured and limit (the most that would pass) in `unit`, None where there is no number."""

    check: str
    status: Status
    measured: float | None = None
    unit: str = ""
    limit: float | None = None
    note: str = ""

    def as_dict(self) -> dict[str, Any]:
        return self._asdict()


def judged(check: str, measured: float, limit: float, unit: str, note: str = "") -> Result:
    """Returns a result that passes if the measured figure is at most the limit."""
    return Result(check, "pass" if measured <= limit else "fail", measured, unit, limit, note)


def told(check: str, holds: bool, note: str = "", measured: float | None = None, unit: str = "") -> Result:
    """Returns a result that passes if something holds."""
    return Result(check, "pass" if holds else "fail", measured, unit, None, note)


def unsupported(check: str, note: str) -> Result:
    """Returns a result for what the drive does not have."""
    return Result(check, "not supported", note=note)
