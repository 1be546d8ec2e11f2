"""What a run spends its time in as machine code, where it lies ready and was made from the present sources.

Compiled, firmware, bus, plant and EKF do the same to the bit in less time.
`scripts/compile.py` makes them; without it, or after a change of the sources, the sources themselves run: so
they do in tests and debuggers, too, which do not ask.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from functools import cached_property
from importlib.machinery import EXTENSION_SUFFIXES, ModuleSpec
from importlib.util import spec_from_file_location
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).parent.parent
"""Where the packages are."""

PARTS = {
    "can": (
        "arbitration", "axis", "base", "contests", "ears", "frame_length", "nmt", "port", "position_axis",
        "queues", "set_point", "station", "stations", "wire",
    ),
    "plant": ("simulated", "pins"),
    "estimation": ("association", "dead_reckoning", "ekf", "measurement", "motion", "timeline"),
}  # fmt: skip
"""The modules of hilbed's packages that are compiled; of the firmware, nearly all are."""

# What surrounds the firmware waits for its bus, or only writes its EDS file: nothing is won there.
_LEFT_OUT = ("__init__.py", "__main__.py", "process.py", "eds.py")
# What compiled modules use of the floors below: its types are built into them.
_USED = ("compiled", "types", "ports", "clock", "cost", "effects", "angles", "chords")
_PREFIXES = ("firmware_sim.", *(f"hilbed.{part}." for part in PARTS))
_OFF = "HILBED_COMPILED"
"""Set to `no`, this variable has the sources run."""


def modules() -> list[Path]:
    """Returns the sources that are to be compiled, relative to ROOT."""
    firmware = [path for path in ROOT.glob("firmware_sim/**/*.py") if path.name not in _LEFT_OUT]
    parts = [ROOT / "hilbed" / part / f"{name}.py" for part, names in PARTS.items() for name in names]
    return sorted(path.relative_to(ROOT) for path in (*firmware, *parts))


def sources() -> list[Path]:
    """Returns all sources that what is compiled depends on: where one changes, it is of no use any more."""
    used = [ROOT / "hilbed" / f"{name}.py" for name in _USED]
    parts = [path for part in PARTS for path in ROOT.glob(f"hilbed/{part}/**/*.py")]
    return sorted((*ROOT.glob("firmware_sim/**/*.py"), *parts, *used))


def place() -> Path:
    """Returns the folder for what is compiled from the present sources for this Python."""
    from hashlib import sha256  # not for `hilbed --help`

    digest = sha256(sys.version.encode())
    for path in sources():
        digest.update(str(path.relative_to(ROOT)).encode() + b"\0" + path.read_bytes())
    return Path(sys.prefix) / "hilbed-compiled" / digest.hexdigest()[:16]


class Compiled:
    """Finds the compiled modules, where there are any, before their sources are found."""

    @cached_property
    def files(self) -> dict[str, Path]:
        """Where each module lies, by its name; looked for when the first of them is wanted."""
        suffix, folder = EXTENSION_SUFFIXES[0], place()
        found = folder.rglob(f"*{suffix}") if folder.is_dir() else ()
        return {".".join(path.relative_to(folder).parts).removesuffix(suffix): path for path in sorted(found)}

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Returns where a module is to be loaded from; None where its source will do."""
        del path, target
        if not name.startswith(_PREFIXES) and not name.endswith("__mypyc"):
            return None
        file = self.files.get(name)
        return spec_from_file_location(name, file) if file else None


def prefer() -> None:
    """Has the compiled modules imported from now on, where there are any, unless HILBED_COMPILED is `no`."""
    if os.environ.get(_OFF) != "no" and not any(isinstance(one, Compiled) for one in sys.meta_path):
        sys.meta_path.insert(0, Compiled())


def active() -> bool:
    """Tells whether the firmware that is in use is a compiled one."""
    module = sys.modules.get("firmware_sim.drive")
    return module is not None and (module.__file__ or "").endswith(EXTENSION_SUFFIXES[0])
