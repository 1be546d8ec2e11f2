"""Loading a scenario: what it imports."""

from __future__ import annotations

import subprocess
import sys

PROGRAM = """
import sys
import hilbed.cli
from hilbed.scenario.load import load

load("demo")
print({"numpy", "scipy", "cv2", "pybullet", "can", "matplotlib"} & set(sys.modules))
"""


def test_a_check_imports_nothing_heavy() -> None:
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"
