"""Property tests: no wall time anywhere, and in CI the same examples every time.

With HILBED_COMPILED=yes the tests run on what is compiled: firmware, bus, plant and EKF.
"""

from __future__ import annotations

import os

from hypothesis import settings

from hilbed import compiled

if os.environ.get("HILBED_COMPILED") == "yes":
    assert compiled.place().is_dir(), "nothing is compiled from the present sources: scripts/setup"
    compiled.prefer()

settings.register_profile("bench", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True)
settings.load_profile("ci" if os.environ.get("CI") else "bench")
