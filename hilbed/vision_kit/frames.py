"""What `hilbed frames` does: a dataset of rendered frames with truth."""

from __future__ import annotations

import sys
from argparse import Namespace
from pathlib import Path

from hilbed.console import end_progress, progress
from hilbed.scenario.load import load, version_warnings
from hilbed.versions import versions
from hilbed.vision_kit.dataset import plan, write_dataset


def frames(options: Namespace) -> int:
    """Writes a dataset, or what is missing of it, and prints its folder; returns 0."""
    settings = list(options.settings)
    if options.count is not None:
        settings.append(f"vision.frames={options.count}")
    loaded = load(options.scenario, settings, options.seed)
    for warning in version_warnings(loaded.scenario, versions()):
        print(f"warning: {warning}", file=sys.stderr)
    planned = plan(loaded)
    folder: Path = options.out
    try:
        there = write_dataset(
            planned, folder, options.force, lambda k: progress(f"frame {k + 1} of {planned.total}")
        )
    finally:
        end_progress()
    if there:
        print(f"{there} of {planned.total} frames were there already", file=sys.stderr)
    print(f"dataset: {folder}")
    return 0
