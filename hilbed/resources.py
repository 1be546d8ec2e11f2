"""Files that ship with the package: inside it when installed, beside it in a working copy."""

from __future__ import annotations

from pathlib import Path

from hilbed.types import ScenarioError


def package_file(name: str) -> Path:
    """Returns the path of a file of the package such as "urdf/diffdrive.urdf"; raises ScenarioError."""
    package = Path(__file__).resolve().parent
    for folder in (package, package.parent):
        path = (folder / name).resolve()
        if path.is_file() and path.is_relative_to(folder):
            return path
    raise ScenarioError(f"package:{name}: no such file in the package")
