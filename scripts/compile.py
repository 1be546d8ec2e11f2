"""Compiles what a run spends its time in with mypyc, for the Python it is called with; quick when it is done.

Needs a C compiler, Python.h and the packages of the extra `compile`.
Usage: python scripts/compile.py [--check]   (--check: only tells, by exit status 1, that it has to be done)
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from shutil import copytree, ignore_patterns, rmtree
from tempfile import TemporaryDirectory

from hilbed import compiled

BUILD = """
import sys
from mypyc.build import mypycify
from setuptools import setup

options = ["--ignore-missing-imports", "--follow-imports=silent"]
extensions = mypycify([*options, *sys.argv[1:]], opt_level="3")
setup(name="compiled", packages=[], ext_modules=extensions, script_args=["-q", "build_ext", "--inplace"])
"""

# Whatever does not load is found out here, not by a run.
TRIAL = """
import sys
from importlib import import_module
from pathlib import Path
from hilbed import compiled

compiled.place = lambda: Path(sys.argv[1])
compiled.prefer()
for path in compiled.modules():
    import_module(".".join(path.with_suffix("").parts))
assert compiled.active()
"""

# A fused multiply-add would round differently from the interpreter.
FLAGS = "-ffp-contract=off"


def build(folder: Path) -> None:
    """Compiles a copy of the sources and puts what comes of it into its place in one step."""
    folder.parent.mkdir(exist_ok=True)
    with TemporaryDirectory(dir=folder.parent, prefix="workshop-") as name:
        workshop = Path(name)
        unwanted = ignore_patterns("__pycache__", "*.so")
        for package in ("firmware_sim", "hilbed"):
            copytree(compiled.ROOT / package, workshop / package, ignore=unwanted)
        command = [sys.executable, "-c", BUILD, *map(str, compiled.modules())]
        subprocess.run(command, cwd=workshop, env={**os.environ, "CFLAGS": FLAGS}, check=True)
        rmtree(workshop / "build")
        made = workshop / "made"
        for library in sorted(workshop.rglob("*.so")):
            target = made / library.relative_to(workshop)
            target.parent.mkdir(parents=True, exist_ok=True)
            library.rename(target)
        subprocess.run([sys.executable, "-c", TRIAL, str(made)], check=True)
        made.rename(folder)


def main() -> int:
    folder = compiled.place()
    if folder.is_dir():
        return 0
    if sys.argv[1:] == ["--check"]:
        return 1
    for old in folder.parent.glob("*"):
        rmtree(old)
    build(folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
