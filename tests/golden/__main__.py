"""`scripts/golden`: shows what has moved against the golden records, or renews them."""

from __future__ import annotations

import argparse
import os
import sys

from tests.golden.compare import moved
from tests.golden.recording import SETTINGS, path, read, take, write


def main() -> int:
    """Returns 0 where nothing has moved, else 1."""
    parser = argparse.ArgumentParser(prog="scripts/golden", description=__doc__)
    parser.add_argument("--renew", action="store_true", help="write the records anew")
    parser.add_argument("scenarios", nargs="*", metavar="SCENARIO", help="all if none is given")
    options = parser.parse_args()
    unknown = [name for name in options.scenarios if name not in SETTINGS]
    if unknown:
        parser.error(f"no golden record of {', '.join(unknown)}; there are {', '.join(SETTINGS)}")
    shown = [show(name, options.renew) for name in options.scenarios or SETTINGS]
    return int(any(shown) and not options.renew)


def show(name: str, renew: bool) -> bool:
    """Prints what has moved in a scenario, renews its record if asked to, and says whether anything has."""
    if name.startswith("recorded/") and not os.environ.get("HILBED_DATA"):
        print(f"{name}: left out, HILBED_DATA names no folder")
        return False
    new = take(name)
    if path(name).exists():
        lines = [str(change) for change in moved(read(name), new)]
        print(f"{name}: {len(lines) or 'nothing'} moved", *lines, sep="\n    ")
    else:
        lines = ["new"]
        print(f"{name}: a new record")
    if renew and lines:
        write(name, new)
    sys.stdout.flush()
    return bool(lines)


if __name__ == "__main__":
    sys.exit(main())
