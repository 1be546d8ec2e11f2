"""What an earlier run of the same paper has left and need not be run again."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from contextlib import suppress
from hashlib import sha256
from pathlib import Path

from hilbed import yaml12
from hilbed.paper.plan import End
from hilbed.record.folder import SCENARIO, SIGNALS, VERDICT, write_whole
from hilbed.scenario.load import Loaded, load, resolved
from hilbed.scenario.own_files import pack
from hilbed.types import Pose
from hilbed.versions import versions

ENDS = "ends.json"


def written(loaded: Loaded) -> str:
    """Returns what a run of this scenario writes as its scenario.yaml."""
    return yaml12.write(resolved(pack(loaded.scenario, loaded.folder).scenario, versions()))


def finished(folder: Path, loaded: Loaded) -> str | None:
    """Returns why a folder's run of this very scenario, seed and versions has failed, "" where it has passed.

    None where there is none, or it did not come to its end.
    """
    with suppress(OSError, ValueError, KeyError, TypeError):
        if (folder / SCENARIO).read_text() == written(loaded) and (folder / SIGNALS).exists():
            verdict = json.loads((folder / VERDICT).read_bytes())
            judged = all(entry["passed"] for entry in verdict["criteria"].values())
            if verdict["passed"] == judged and verdict["sim_time"] >= loaded.scenario.duration - 1e-9:
                return str(verdict["reason"])
    return None


class KeptEnds:
    """Final poses of earlier runs, in one file beside the page; those of another scenario do not count."""

    def __init__(self, folder: Path, scenarios: Iterable[str]) -> None:
        self._path = folder / ENDS
        self._digests = {name: _digest(name) for name in scenarios}

    def read(self) -> dict[End, Pose]:
        """Returns what is there, nothing where the file cannot be read."""
        with suppress(OSError, ValueError, KeyError, TypeError, AttributeError):
            return {
                End(name, int(seed)): Pose(*pose)
                for name, entry in json.loads(self._path.read_bytes()).items()
                if entry["digest"] == self._digests.get(name)
                for seed, pose in entry["poses"].items()
            }
        return {}

    def write(self, poses: Mapping[End, Pose]) -> None:
        """Writes all that is known; raises RecordError."""
        content = {
            name: {"digest": digest, "poses": {str(end.seed): pose for end, pose in _of(poses, name)}}
            for name, digest in self._digests.items()
        }
        if content:
            write_whole(self._path, json.dumps(content).encode())


def _of(poses: Mapping[End, Pose], scenario: str) -> list[tuple[End, Pose]]:
    return [(end, pose) for end, pose in poses.items() if end.scenario == scenario]


def _digest(scenario: str) -> str:
    return sha256(written(load(scenario, (), 0)).encode()).hexdigest()
